// A server's part in a cluster: the leases that it holds in Redis, the copies of its sessions there, and what it takes
// over of servers that are gone.
#ifndef PHRENIC_SERVER_CLUSTER_CLUSTER_H_
#define PHRENIC_SERVER_CLUSTER_CLUSTER_H_

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/status/statusor.h"
#include "absl/synchronization/mutex.h"
#include "server/cluster/redis.h"
#include "server/store/ownership.h"

namespace phrenic::cluster {

struct ClusterOptions {
  std::string redis;      // "redis://HOST:PORT"; empty: a server by itself
  std::string advertise;  // "HOST:PORT" at which the others reach this server's gRPC
};

// Where a session is.
struct Place {
  enum class Kind {
    kHere,       // this server has it
    kElsewhere,  // another one has it, at `address`
    kBetween,    // its server is gone, and another one will go on with it
    kNowhere,    // there is none
    kUnknown,    // Redis cannot be asked, and it is not here
  };
  Kind kind = Kind::kNowhere;
  std::string address = {};
};

// What goes on, for /metrics.
struct ClusterCounts {
  int owned = 0, servers = 0;
  bool reached = false;  // Redis, at the last attempt
  std::int64_t taken = 0, lost = 0;
};

// Any thread may call, but where store::Ownership says otherwise. A lease of kLease is renewed by a thread that does
// nothing else; another one looks for sessions that nobody has. Nothing waits for Redis longer than Redis::kPatience,
// and where that is gone sessions go on as they are: leases change hands only through it.
class Cluster final : public store::Ownership {
 public:
  struct Hooks {
    // Another server has the session: it ends here. Must not wait.
    std::function<void(const std::string& id)> lost;
    // Goes on with a session; the thread that looks for them calls. Refused ones stay for others.
    std::function<absl::Status(const store::SavedSession& saved, std::int64_t epoch)> take_over;
    // Has the store copy these whole.
    std::function<void(const std::vector<std::string>& ids)> copy_whole;
  };

  // INVALID_ARGUMENT for an address that is none, UNAVAILABLE where Redis cannot be reached.
  static absl::StatusOr<std::unique_ptr<Cluster>> Join(const ClusterOptions& options);
  ~Cluster() override;

  // Renews leases from now on; before any are asked for. The hooks outlive Leave.
  void Begin(Hooks hooks);
  // Takes over what nobody has, from now on: this server can be called.
  void Watch();
  // Takes over nothing more, and no session is here for callers; the leases stay until Leave or Release.
  void Rest();
  // Renews no more leases.
  void Leave();

  absl::StatusOr<std::int64_t> Claim(const std::string& id) override ABSL_LOCKS_EXCLUDED(mutex_, calls_mutex_);
  absl::StatusOr<std::int64_t> Reclaim(const store::SavedSession& saved) override
      ABSL_LOCKS_EXCLUDED(mutex_, calls_mutex_);
  void Abandon(const std::string& id) override ABSL_LOCKS_EXCLUDED(mutex_, calls_mutex_);
  void Release(const std::string& id) override ABSL_LOCKS_EXCLUDED(mutex_, calls_mutex_);
  bool Copy(const store::Written& written) override ABSL_LOCKS_EXCLUDED(mutex_);
  void CopyWhole(const store::SavedSession& saved) override ABSL_LOCKS_EXCLUDED(mutex_);

  // A lease that is over by this server's own clock is renewed first: who was stopped for a while may have lost it.
  Place Where(const std::string& id) ABSL_LOCKS_EXCLUDED(mutex_, calls_mutex_);
  // Nobody answered there: the next call asks Redis again.
  void Forget(const std::string& id) ABSL_LOCKS_EXCLUDED(mutex_);
  // The addresses of the others that take sessions.
  std::vector<std::string> Others() const ABSL_LOCKS_EXCLUDED(mutex_);
  ClusterCounts counts() const ABSL_LOCKS_EXCLUDED(mutex_);
  const std::string& address() const { return address_; }

  static constexpr std::chrono::milliseconds kLease{3000};

 private:
  using Clock = std::chrono::steady_clock;
  struct Own {
    std::int64_t epoch = 0;
    Clock::time_point until;  // of the lease
    bool behind = false;      // its copy is not whole
    bool ready = true;        // it can be called
  };
  struct Seen {
    Place place;
    Clock::time_point until;
  };

  Cluster(const RedisAddress& redis, std::string address);
  // Redis does not answer, and that is no news.
  bool KnownGone() const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  std::int64_t Hold(const std::string& id, std::int64_t epoch, Clock::time_point asked, bool ready = true)
      ABSL_LOCKS_EXCLUDED(mutex_);
  std::optional<std::int64_t> EpochOf(const std::string& id) const ABSL_LOCKS_EXCLUDED(mutex_);
  absl::StatusOr<Reply> Ask(const char* script, const std::vector<std::string>& arguments)
      ABSL_LOCKS_EXCLUDED(calls_mutex_);
  // The same for one session of this server: 1, 0 where it is another's by now, or UNAVAILABLE.
  absl::StatusOr<std::int64_t> Save(const std::string& id, std::vector<std::string> words);
  void SetBehind(const std::string& id, bool behind) ABSL_LOCKS_EXCLUDED(mutex_);
  // Has the session's copy made whole where it is behind; false where that takes too long.
  bool AwaitWhole(const std::string& id) ABSL_LOCKS_EXCLUDED(mutex_);
  void Renew(Redis& redis) ABSL_LOCKS_EXCLUDED(mutex_);
  std::vector<std::string> NoteRenewed(const std::vector<std::pair<std::string, std::int64_t>>& own,
                                       const Reply& answers, Clock::time_point asked, bool anew)
      ABSL_LOCKS_EXCLUDED(mutex_);
  void KeepRenewing();
  void KeepLooking();
  void Look(Redis& redis, std::map<std::string, Clock::time_point>& free);
  // False where it cannot be gone on with here.
  bool Take(Redis& redis, const std::string& id);

  const std::string address_;
  const std::string lease_;  // [ms]
  Hooks hooks_;
  absl::Mutex calls_mutex_;
  Redis calls_ ABSL_GUARDED_BY(calls_mutex_);
  Redis saving_;  // of the store's thread
  const RedisAddress redis_;

  mutable absl::Mutex mutex_;
  std::map<std::string, Own> own_ ABSL_GUARDED_BY(mutex_);
  std::map<std::string, Seen> seen_ ABSL_GUARDED_BY(mutex_);  // where others' are, for a moment
  std::vector<std::string> servers_ ABSL_GUARDED_BY(mutex_);
  bool resting_ ABSL_GUARDED_BY(mutex_) = false;  // sessions are on their way elsewhere
  bool takes_ ABSL_GUARDED_BY(mutex_) = false, leaving_ ABSL_GUARDED_BY(mutex_) = false;
  bool hurry_ ABSL_GUARDED_BY(mutex_) = false;  // renew at once
  bool reached_ ABSL_GUARDED_BY(mutex_) = false;
  Clock::time_point reached_since_ ABSL_GUARDED_BY(mutex_), tried_ ABSL_GUARDED_BY(mutex_);
  std::int64_t taken_ ABSL_GUARDED_BY(mutex_) = 0, lost_ ABSL_GUARDED_BY(mutex_) = 0;
  std::thread renewing_, looking_;
};

}  // namespace phrenic::cluster

#endif  // PHRENIC_SERVER_CLUSTER_CLUSTER_H_
