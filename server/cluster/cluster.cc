#include "server/cluster/cluster.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "server/cluster/scripts.h"

namespace phrenic::cluster {
namespace {

constexpr std::chrono::milliseconds kCacheTime(500);       // of another server's session
constexpr absl::Duration kCopyTimeout = absl::Seconds(2);  // to complete a copy before a release
constexpr std::size_t kMaxCached = 100'000;

absl::Status Unreachable(const std::string& id, const absl::Status& why) {
  return absl::UnavailableError(absl::StrCat("session \"", id, "\": Redis cannot be asked which server has it; ",
                                             std::string(why.message()), ", and try again"));
}

// Returns ADDRESS of a lease "EPOCH ADDRESS".
std::string AddressOf(const std::string& lease) { return lease.substr(lease.find(' ') + 1); }

}  // namespace

Cluster::Cluster(const RedisAddress& redis, std::string address)
    : address_(std::move(address)),
      lease_(std::to_string(kLease.count())),
      calls_(redis),
      copies_(redis),
      redis_(redis) {}

absl::StatusOr<std::unique_ptr<Cluster>> Cluster::Join(const ClusterOptions& options) {
  auto redis = ParseRedisAddress(options.redis);
  if (!redis.ok()) return redis.status();
  redis->tls = options.tls;
  std::unique_ptr<Cluster> cluster(new Cluster(*redis, options.advertise));
  absl::MutexLock lock(&cluster->calls_mutex_);
  const auto answer = cluster->calls_.Run({"PING"});
  if (!answer.ok()) {
    return absl::UnavailableError(absl::StrCat("--cluster: ", std::string(answer.status().message()),
                                               ", or start this server without --cluster"));
  }
  return cluster;
}

Cluster::~Cluster() {
  Drain();
  Leave();
}

absl::StatusOr<Reply> Cluster::Run(const char* script, const std::vector<std::string>& arguments) {
  absl::MutexLock lock(&calls_mutex_);
  return calls_.Run(script, arguments);
}

std::int64_t Cluster::AddLease(const std::string& id, std::int64_t epoch, Clock::time_point requested, bool ready) {
  absl::MutexLock lock(&mutex_);
  owned_[id] = {.epoch = epoch, .expires = requested + kLease, .ready = ready};
  cache_.erase(id);
  return epoch;
}

std::optional<std::int64_t> Cluster::EpochOf(const std::string& id) const {
  absl::MutexLock lock(&mutex_);
  const auto own = owned_.find(id);
  return own == owned_.end() ? std::nullopt : std::optional(own->second.epoch);
}

absl::StatusOr<std::int64_t> Cluster::Claim(const std::string& id) {
  const Clock::time_point requested = Clock::now();
  const auto epoch = Run(kClaim, {id, address_, lease_});
  if (!epoch.ok()) return Unreachable(id, epoch.status());
  if (epoch->number > 0) return AddLease(id, epoch->number, requested);
  return absl::AlreadyExistsError(
      absl::StrCat("session \"", id, "\" exists already, on another server of the cluster"));
}

absl::StatusOr<std::int64_t> Cluster::Reclaim(const store::SavedSession& saved) {
  const v1::SavedMoment& last = saved.later.empty() ? saved.moment : saved.later.back();
  const Clock::time_point requested = Clock::now();
  const auto epoch = Run(
      kReclaim, {saved.id, address_, lease_, std::to_string(last.session().epoch()), std::to_string(saved.sequence)});
  if (!epoch.ok()) return Unreachable(saved.id, epoch.status());
  if (epoch->number <= 0) {
    return absl::FailedPreconditionError(
        absl::StrCat("session ", saved.id, ": another server of the cluster has or had it since, or it was deleted"));
  }
  AddLease(saved.id, epoch->number, requested);
  SetCopyIncomplete(saved.id, true);
  return epoch->number;
}

void Cluster::Release(const std::string& id) {
  const auto epoch = EpochOf(id);
  if (!epoch.has_value()) return;
  if (!AwaitCompleteCopy(id)) return;  // another server could not resume the last state: lets the lease expire
  {
    absl::MutexLock lock(&mutex_);
    owned_.erase(id);
  }
  Run(kRelease, {id, std::to_string(*epoch)}).IgnoreError();
}

bool Cluster::AwaitCompleteCopy(const std::string& id) {
  const auto complete = [this, &id] {
    mutex_.AssertReaderHeld();
    const auto own = owned_.find(id);
    return own == owned_.end() || !own->second.copy_incomplete;
  };
  {
    absl::MutexLock lock(&mutex_);
    if (complete()) return true;
  }
  hooks_.copy_whole({id});
  absl::MutexLock lock(&mutex_);
  return mutex_.AwaitWithTimeout(absl::Condition(&complete), kCopyTimeout);
}

void Cluster::Abandon(const std::string& id) {
  SetCopyIncomplete(id, false);
  Release(id);
}

bool Cluster::RedisKnownDown() const { return !redis_reachable_ && Clock::now() < last_renewal_ + kLease / 2; }

absl::Status Cluster::CheckLease(const std::string& id) const {
  absl::MutexLock lock(&mutex_);
  const auto own = owned_.find(id);
  if (own == owned_.end()) {
    return absl::AbortedError(absl::StrCat("session \"", id, "\" continues on another server; call again"));
  }
  if (Clock::now() + kMargin < own->second.expires) return absl::OkStatus();
  return absl::UnavailableError(
      absl::StrCat("session \"", id,
                   "\" cannot be changed: this server's lease on it has ended and Redis, which has "
                   "not answered since, may have given it to another server. It can be watched here meanwhile; try "
                   "again, or start Redis"));
}

std::optional<Location> Cluster::LocateFromCache(const std::string& id, bool& expired) const {
  absl::MutexLock lock(&mutex_);
  if (const auto own = owned_.find(id); own != owned_.end()) {
    if (draining_ || !own->second.ready) return Location{Location::Kind::kMoving};
    expired = own->second.expires <= Clock::now();
    if (!expired || RedisKnownDown()) return Location{Location::Kind::kLocal};
    return std::nullopt;
  }
  const auto cached = cache_.find(id);
  const bool valid = cached != cache_.end() && (Clock::now() < cached->second.expires || !redis_reachable_);
  if (valid) return cached->second.location;
  if (RedisKnownDown()) return Location{Location::Kind::kUnknown};
  return std::nullopt;
}

Location Cluster::Locate(const std::string& id) {
  bool expired = false;
  if (const auto known = LocateFromCache(id, expired); known.has_value()) return *known;
  if (expired) {
    absl::MutexLock lock(&calls_mutex_);
    Renew(calls_);
    if (EpochOf(id).has_value()) return {Location::Kind::kLocal};
  }
  return LocateInRedis(id);
}

Location Cluster::LocateInRedis(const std::string& id) {
  const auto answer = Run(kLocate, {id});
  if (!answer.ok() || answer->list.size() != 2) return {Location::Kind::kUnknown};
  const std::string& lease = answer->list[0].text;
  const bool has_copy = answer->list[1].number == 1;
  if (lease.empty()) return {has_copy ? Location::Kind::kMoving : Location::Kind::kNone};
  Location location = {Location::Kind::kRemote, AddressOf(lease)};
  // A lease of this server from before a restart: it has not reclaimed the session yet.
  if (location.address == address_) return {Location::Kind::kMoving};
  absl::MutexLock lock(&mutex_);
  if (cache_.size() >= kMaxCached) cache_.clear();
  cache_[id] = {location, Clock::now() + kCacheTime};
  return location;
}

void Cluster::Forget(const std::string& id) {
  absl::MutexLock lock(&mutex_);
  if (redis_reachable_) cache_.erase(id);
}

std::vector<std::string> Cluster::Others() const {
  absl::MutexLock lock(&mutex_);
  std::vector<std::string> others;
  for (const std::string& server : servers_) {
    if (server != address_) others.push_back(server);
  }
  return others;
}

ClusterCounts Cluster::counts() const {
  absl::MutexLock lock(&mutex_);
  return {static_cast<int>(owned_.size()), static_cast<int>(servers_.size()), redis_reachable_, taken_over_, lost_};
}

}  // namespace phrenic::cluster
