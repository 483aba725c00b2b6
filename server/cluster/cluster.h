// This server's part in a cluster: the leases that it holds in Redis, the copies of its sessions there, and the
// sessions that it takes over from servers that are gone. README.md describes the protocol.
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

// What a server needs to join a cluster, from its settings.
struct ClusterOptions {
  std::string redis;       // "redis://HOST:PORT" or "rediss://HOST:PORT"; empty: not in a cluster
  std::string advertise;   // "HOST:PORT" at which the other servers reach this server's gRPC
  RedisTlsFiles tls = {};  // of connections to a "rediss://" and, its CA, to the other servers
};

// Where a session is.
struct Location {
  enum class Kind {
    kLocal,    // this server holds the lease
    kRemote,   // another server holds the lease, at `address`
    kMoving,   // no server holds the lease; one will take the session over
    kNone,     // there is no such session
    kUnknown,  // not here, and Redis does not answer
  };
  Kind kind = Kind::kNone;
  std::string address = {};
};

// Counts for /metrics, of this server since it started.
struct ClusterCounts {
  int owned = 0, servers = 0;
  bool redis_reachable = false;  // at the last attempt
  std::int64_t taken_over = 0, lost = 0;
};

// Holds a lease of kLease on each of this server's sessions. One thread only renews leases, another finds sessions
// without a lease and takes them over. No call waits for Redis longer than Redis::kTimeout. While Redis does not
// answer, sessions stay where they are, because leases change only in Redis; once a lease has ended by this server's
// monotonic clock, kMargin early, CheckLease refuses changes. Thread-safe, except where store::Ownership says
// otherwise.
class Cluster final : public store::Ownership {
 public:
  struct Hooks {
    // Another server has the session now; it must end here. Must not block.
    std::function<void(const std::string& id)> lost;
    // Resumes a session from its copy; called by the thread that takes over. After an error the lease is released, for
    // another server to try.
    std::function<absl::Status(const store::SavedSession& saved, std::int64_t epoch)> take_over;
    // Has the store write complete copies of these sessions (CopyWhole).
    std::function<void(const std::vector<std::string>& ids)> copy_whole;
  };

  // Connects to Redis. INVALID_ARGUMENT for a bad address, UNAVAILABLE if Redis cannot be reached.
  static absl::StatusOr<std::unique_ptr<Cluster>> Join(const ClusterOptions& options);
  ~Cluster() override;

  // Starts to renew leases, every 0.7 s. Call it before the first Claim. The hooks stay valid until Leave returns; the
  // threads of leases and takeovers call them, without a lock.
  void Start(Hooks hooks);
  // Starts to take over sessions without a lease. Call it when this server accepts calls.
  void StartTakeovers();
  // Stops taking over; Locate returns kMoving for this server's sessions. Leases stay until Release or Leave.
  // Idempotent.
  void Drain();
  // Stops renewing leases; those that are left expire. Idempotent.
  void Leave();

  // store::Ownership says what these do; each that asks Redis waits for it for Redis::kTimeout at most.
  absl::StatusOr<std::int64_t> Claim(const std::string& id) override ABSL_LOCKS_EXCLUDED(mutex_, calls_mutex_);
  absl::StatusOr<std::int64_t> Reclaim(const store::SavedSession& saved) override
      ABSL_LOCKS_EXCLUDED(mutex_, calls_mutex_);
  void Abandon(const std::string& id) override ABSL_LOCKS_EXCLUDED(mutex_, calls_mutex_);
  void Release(const std::string& id) override ABSL_LOCKS_EXCLUDED(mutex_, calls_mutex_);
  absl::Status CheckLease(const std::string& id) const override ABSL_LOCKS_EXCLUDED(mutex_);
  absl::Status Delete(const std::string& id) override ABSL_LOCKS_EXCLUDED(mutex_, calls_mutex_);
  store::Copied Copy(const store::Written& written) override ABSL_LOCKS_EXCLUDED(mutex_);
  store::Copied CopyWhole(const store::SavedSession& saved) override ABSL_LOCKS_EXCLUDED(mutex_);

  // Returns where a session is. Renews a lease first if it has expired by this server's clock, because a server that
  // was suspended may have lost it. Caches other servers' sessions for 0.5 s.
  Location Locate(const std::string& id) ABSL_LOCKS_EXCLUDED(mutex_, calls_mutex_);
  // Drops the cached location of a session whose server did not answer.
  void Forget(const std::string& id) ABSL_LOCKS_EXCLUDED(mutex_);
  // Returns the addresses of the other servers that accept sessions.
  std::vector<std::string> Others() const ABSL_LOCKS_EXCLUDED(mutex_);
  ClusterCounts counts() const ABSL_LOCKS_EXCLUDED(mutex_);
  // Returns ClusterOptions::advertise.
  const std::string& address() const { return address_; }

  // Time for which a lease lasts without renewal: that in which sessions of a failed server are taken over.
  static constexpr std::chrono::milliseconds kLease{3000};
  // A lease counts as ended this much early: two clocks differ by less in the time of a lease.
  static constexpr std::chrono::milliseconds kMargin{300};

 private:
  using Clock = std::chrono::steady_clock;
  // A session of this server.
  struct Owned {
    std::int64_t epoch = 0;
    Clock::time_point expires;     // of the lease
    bool copy_incomplete = false;  // its copy in Redis must be written whole
    bool ready = true;             // accepts calls
  };
  struct CachedLocation {
    Location location;
    Clock::time_point expires;
  };

  Cluster(const RedisAddress& redis, std::string address);
  // True if Redis did not answer recently, so that asking again would only wait.
  bool RedisKnownDown() const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Records a lease that was requested at `requested`. Returns its epoch.
  std::int64_t AddLease(const std::string& id, std::int64_t epoch, Clock::time_point requested, bool ready = true)
      ABSL_LOCKS_EXCLUDED(mutex_);
  // Returns the epoch of a session of this server; nullopt if it is not here.
  std::optional<std::int64_t> EpochOf(const std::string& id) const ABSL_LOCKS_EXCLUDED(mutex_);
  // Runs a script of scripts.h on the connection of calls. The errors of Redis::Run.
  absl::StatusOr<Reply> Run(const char* script, const std::vector<std::string>& arguments)
      ABSL_LOCKS_EXCLUDED(calls_mutex_);
  // Returns the location that is known without Redis; nullopt if Redis must be asked. Sets `expired` if this server has
  // the session but its lease has expired.
  std::optional<Location> LocateFromCache(const std::string& id, bool& expired) const ABSL_LOCKS_EXCLUDED(mutex_);
  // Asks Redis, and caches the answer if another server has the session. kUnknown if Redis does not answer.
  Location LocateInRedis(const std::string& id) ABSL_LOCKS_EXCLUDED(mutex_, calls_mutex_);
  // Runs kSave for a session of this server. Returns 1 if it was written, 0 if another server has the session or it was
  // deleted; UNAVAILABLE if Redis does not answer.
  absl::StatusOr<std::int64_t> WriteCopy(const std::string& id, std::vector<std::string> arguments);
  // Deletes the copy of a session that was deleted here.
  store::Copied CopyDeletion(const std::string& id) ABSL_LOCKS_EXCLUDED(mutex_);
  // Records whether a copy lacks something: then the next renewal has it written whole.
  void SetCopyIncomplete(const std::string& id, bool incomplete) ABSL_LOCKS_EXCLUDED(mutex_);
  // Has an incomplete copy written whole and waits for it. False after 2 s.
  bool AwaitCompleteCopy(const std::string& id) ABSL_LOCKS_EXCLUDED(mutex_);
  // Renews all leases in one script call; reports lost sessions and incomplete copies to the hooks.
  void Renew(Redis& redis) ABSL_LOCKS_EXCLUDED(mutex_);
  // Applies the answers of kRenew. Returns the ids of lost sessions.
  std::vector<std::string> ApplyRenewal(const std::vector<std::pair<std::string, std::int64_t>>& leases,
                                        const Reply& answers, Clock::time_point requested, bool reconnected)
      ABSL_LOCKS_EXCLUDED(mutex_);
  // The functions of the two threads; they end once `leaving_` is set.
  void RenewalLoop();
  void TakeoverLoop();
  // Takes over sessions without a lease; `free_since` has when each was first seen without one.
  void TakeOverFreeSessions(Redis& redis, std::map<std::string, Clock::time_point>& free_since);
  // False if the session could not be resumed here.
  bool TakeOver(Redis& redis, const std::string& id);

  const std::string address_;
  const std::string lease_;  // [ms]
  Hooks hooks_;
  absl::Mutex calls_mutex_;
  Redis calls_ ABSL_GUARDED_BY(calls_mutex_);
  Redis copies_;             // used by the store's thread
  std::int64_t writes_ = 0;  // of copies_
  const RedisAddress redis_;

  mutable absl::Mutex mutex_;
  std::map<std::string, Owned> owned_ ABSL_GUARDED_BY(mutex_);
  std::map<std::string, CachedLocation> cache_ ABSL_GUARDED_BY(mutex_);
  std::vector<std::string> servers_ ABSL_GUARDED_BY(mutex_);
  bool draining_ ABSL_GUARDED_BY(mutex_) = false;  // this server's sessions accept no calls
  bool takes_over_ ABSL_GUARDED_BY(mutex_) = false, leaving_ ABSL_GUARDED_BY(mutex_) = false;
  bool renew_now_ ABSL_GUARDED_BY(mutex_) = false;
  bool redis_reachable_ ABSL_GUARDED_BY(mutex_) = false;
  Clock::time_point reachable_since_ ABSL_GUARDED_BY(mutex_), last_renewal_ ABSL_GUARDED_BY(mutex_);
  std::int64_t taken_over_ ABSL_GUARDED_BY(mutex_) = 0, lost_ ABSL_GUARDED_BY(mutex_) = 0;
  std::thread renewal_thread_, takeover_thread_;
};

}  // namespace phrenic::cluster

#endif  // PHRENIC_SERVER_CLUSTER_CLUSTER_H_
