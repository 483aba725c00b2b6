#include "server/cluster/cluster.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "server/cluster/scripts.h"

namespace phrenic::cluster {
namespace {

// For how long it is believed where another server's session is.
constexpr std::chrono::milliseconds kBelieved(500);
constexpr absl::Duration kWholePatience = absl::Seconds(2);  // for a copy that is behind
constexpr std::size_t kMostSeen = 100'000;

absl::Status Unreachable(const std::string& id, const absl::Status& why) {
  return absl::UnavailableError(absl::StrCat("session \"", id, "\": the cluster cannot be asked whose it is; ",
                                             std::string(why.message()), ", and try again"));
}

// "EPOCH ADDRESS"
std::string AddressOf(const std::string& lease) { return lease.substr(lease.find(' ') + 1); }

}  // namespace

Cluster::Cluster(const RedisAddress& redis, std::string address)
    : address_(std::move(address)),
      lease_(std::to_string(kLease.count())),
      calls_(redis),
      saving_(redis),
      redis_(redis) {}

absl::StatusOr<std::unique_ptr<Cluster>> Cluster::Join(const ClusterOptions& options) {
  auto redis = ParseRedisAddress(options.redis);
  if (!redis.ok()) return redis.status();
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
  Rest();
  Leave();
}

absl::StatusOr<Reply> Cluster::Ask(const char* script, const std::vector<std::string>& arguments) {
  absl::MutexLock lock(&calls_mutex_);
  return calls_.Run(script, arguments);
}

std::int64_t Cluster::Hold(const std::string& id, std::int64_t epoch, Clock::time_point asked, bool ready) {
  absl::MutexLock lock(&mutex_);
  own_[id] = {.epoch = epoch, .until = asked + kLease, .ready = ready};
  seen_.erase(id);
  return epoch;
}

std::optional<std::int64_t> Cluster::EpochOf(const std::string& id) const {
  absl::MutexLock lock(&mutex_);
  const auto own = own_.find(id);
  return own == own_.end() ? std::nullopt : std::optional(own->second.epoch);
}

absl::StatusOr<std::int64_t> Cluster::Claim(const std::string& id) {
  const Clock::time_point asked = Clock::now();
  const auto epoch = Ask(kClaim, {id, address_, lease_});
  if (!epoch.ok()) return Unreachable(id, epoch.status());
  if (epoch->number > 0) return Hold(id, epoch->number, asked);
  return absl::AlreadyExistsError(
      absl::StrCat("there is a session \"", id, "\" already, on another server of the cluster"));
}

absl::StatusOr<std::int64_t> Cluster::Reclaim(const store::SavedSession& saved) {
  const v1::SavedMoment& last = saved.later.empty() ? saved.moment : saved.later.back();
  const Clock::time_point asked = Clock::now();
  const auto epoch = Ask(
      kReclaim, {saved.id, address_, lease_, std::to_string(last.session().epoch()), std::to_string(saved.sequence)});
  if (!epoch.ok()) return Unreachable(saved.id, epoch.status());
  if (epoch->number <= 0) {
    return absl::FailedPreconditionError(absl::StrCat(
        "session ", saved.id, ": another server of the cluster has it, or had it last, or it was deleted"));
  }
  Hold(saved.id, epoch->number, asked);
  SetBehind(saved.id, true);
  return epoch->number;
}

void Cluster::Release(const std::string& id) {
  const auto epoch = EpochOf(id);
  if (!epoch.has_value()) return;
  if (!AwaitWhole(id)) return;  // nobody could go on from where it stands: the lease stays until it ends
  {
    absl::MutexLock lock(&mutex_);
    own_.erase(id);
  }
  Ask(kRelease, {id, std::to_string(*epoch)}).IgnoreError();
}

bool Cluster::AwaitWhole(const std::string& id) {
  const auto whole = [this, &id] {
    mutex_.AssertReaderHeld();
    const auto own = own_.find(id);
    return own == own_.end() || !own->second.behind;
  };
  {
    absl::MutexLock lock(&mutex_);
    if (whole()) return true;
  }
  hooks_.copy_whole({id});
  absl::MutexLock lock(&mutex_);
  return mutex_.AwaitWithTimeout(absl::Condition(&whole), kWholePatience);
}

void Cluster::Abandon(const std::string& id) {
  SetBehind(id, false);
  Release(id);
}

bool Cluster::KnownGone() const { return !reached_ && Clock::now() < tried_ + kLease / 2; }

Place Cluster::Where(const std::string& id) {
  bool late = false;
  {
    absl::MutexLock lock(&mutex_);
    const auto own = own_.find(id);
    if (own != own_.end() && (resting_ || !own->second.ready)) return {Place::Kind::kBetween};
    late = own != own_.end() && own->second.until <= Clock::now();
    if (own != own_.end() && (!late || KnownGone())) return {Place::Kind::kHere};
    const auto seen = seen_.find(id);
    const bool believed = seen != seen_.end() && (Clock::now() < seen->second.until || !reached_);
    if (own == own_.end() && believed) return seen->second.place;
    if (KnownGone()) return {Place::Kind::kUnknown};
  }
  if (late) {
    absl::MutexLock lock(&calls_mutex_);
    Renew(calls_);
    if (EpochOf(id).has_value()) return {Place::Kind::kHere};
  }
  const auto answer = Ask(kWhere, {id});
  if (!answer.ok() || answer->list.size() != 2) return {Place::Kind::kUnknown};
  Place place;
  const std::string& lease = answer->list[0].text;
  if (!lease.empty()) {
    place = {Place::Kind::kElsewhere, AddressOf(lease)};
    // Its own of before a restart, which it has not come to yet.
    if (place.address == address_) place = {Place::Kind::kBetween};
  } else if (answer->list[1].number == 1) {
    place.kind = Place::Kind::kBetween;
  }
  absl::MutexLock lock(&mutex_);
  if (seen_.size() >= kMostSeen) seen_.clear();
  if (place.kind == Place::Kind::kElsewhere) seen_[id] = {place, Clock::now() + kBelieved};
  return place;
}

void Cluster::Forget(const std::string& id) {
  absl::MutexLock lock(&mutex_);
  if (reached_) seen_.erase(id);
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
  return {static_cast<int>(own_.size()), static_cast<int>(servers_.size()), reached_, taken_, lost_};
}

}  // namespace phrenic::cluster
