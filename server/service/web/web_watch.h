// The messages of one WatchFrames call that the gateway takes from the publisher itself, without gRPC.
#ifndef PHRENIC_SERVER_SERVICE_WEB_WEB_WATCH_H_
#define PHRENIC_SERVER_SERVICE_WEB_WEB_WATCH_H_

#include <utility>
// Boost 1.74's Asio needs <utility> before it with C++20.
#include <atomic>
#include <boost/asio/any_io_executor.hpp>
#include <functional>
#include <memory>
#include <string>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"
#include "server/service/watch/watch_claims.h"
#include "server/stream/viewer.h"

namespace phrenic::service {

// Not thread-safe: use it on `strand`. WebConnection makes one for each WatchFrames call, which carries key() as
// kWatchClaimKey, and destroys it before the call's end is sent or the connection is closed. Without a watch, because
// another server has the session, Take finds nothing, and the messages arrive over gRPC (WebCall).
class WebWatch {
 public:
  // `ready` is called on the strand when Take may have a message, possibly after the object is destroyed. `claims`
  // outlives it.
  WebWatch(WatchClaims& claims, const boost::asio::any_io_executor& strand, std::function<void()> ready);
  ~WebWatch();
  WebWatch(const WebWatch&) = delete;
  WebWatch& operator=(const WebWatch&) = delete;

  const std::string& key() const { return claim_->key(); }
  // Returns the next message; null if none may be sent now. Call NoteSent when it is written.
  stream::Bytes Take();
  void NoteSent();

 private:
  // Posts `ready` to the strand, once until it runs, however often the watch is ready.
  struct Wake {
    boost::asio::any_io_executor strand;
    std::function<void()> ready;
    std::atomic<bool> posted = false;
  };
  static void Post(const std::shared_ptr<Wake>& wake);
  // Runs on a thread of the service.
  void Accept(std::shared_ptr<ClaimedWatch> watch) ABSL_LOCKS_EXCLUDED(mutex_);
  std::shared_ptr<ClaimedWatch> watch() const ABSL_LOCKS_EXCLUDED(mutex_);

  const std::shared_ptr<Wake> wake_;
  mutable absl::Mutex mutex_;
  std::shared_ptr<ClaimedWatch> watch_ ABSL_GUARDED_BY(mutex_);  // null until the service gives it; set once
  std::unique_ptr<WatchClaims::Claim> claim_;                    // the last: its taker uses the others
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_WEB_WEB_WATCH_H_
