// Claims of WatchFrames calls whose messages the web gateway takes from the publisher, without gRPC.
#ifndef PHRENIC_SERVER_SERVICE_WATCH_WATCH_CLAIMS_H_
#define PHRENIC_SERVER_SERVICE_WATCH_WATCH_CLAIMS_H_

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"

namespace phrenic::service {

class ClaimedWatch;

// Thread-safe. The server has one. The web gateway claims the watch of a call before it makes the call, which carries
// the claim's key as kWatchClaimKey; FrameService gives the watch. A key is a random secret of 128 bits, sent to no one
// but other servers of the cluster, so no client can claim another's watch. A key that this server did not make has no
// effect: the messages then go over gRPC.
class WatchClaims {
 public:
  // Called once, on a thread of the service, with the lock held: it must not block or call the claims.
  using Taker = std::function<void(std::shared_ptr<ClaimedWatch> watch)>;

  // A claim, until it is destroyed; the taker does not run afterwards. The claims outlive it.
  class Claim {
   public:
    Claim(WatchClaims& claims, std::string key) : claims_(claims), key_(std::move(key)) {}
    ~Claim() { claims_.Remove(key_); }
    Claim(const Claim&) = delete;
    Claim& operator=(const Claim&) = delete;
    const std::string& key() const { return key_; }

   private:
    WatchClaims& claims_;
    const std::string key_;
  };

  std::unique_ptr<Claim> Add(Taker taker) ABSL_LOCKS_EXCLUDED(mutex_);
  // True if a claim has this key and its watch was not given yet.
  bool Has(const std::string& key) const ABSL_LOCKS_EXCLUDED(mutex_);
  // Gives the watch to the claim's taker. False if there is no such claim, or if it has its watch.
  bool Give(const std::string& key, std::shared_ptr<ClaimedWatch> watch) ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  void Remove(const std::string& key) ABSL_LOCKS_EXCLUDED(mutex_);

  mutable absl::Mutex mutex_;
  std::map<std::string, Taker> takers_ ABSL_GUARDED_BY(mutex_);  // by key; of claims without a watch
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_WATCH_WATCH_CLAIMS_H_
