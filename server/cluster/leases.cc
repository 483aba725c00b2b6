// Cluster's methods that renew leases and take over sessions without a lease.
#include <pthread.h>

#include <algorithm>
#include <utility>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "server/cluster/cluster.h"
#include "server/cluster/scripts.h"
#include "server/crypto/sha256.h"

namespace phrenic::cluster {
namespace {

constexpr absl::Duration kRenewalPeriod = absl::Milliseconds(700), kTakeoverPeriod = absl::Milliseconds(150);
// How long servers other than the preferred one wait before they take over a session.
constexpr std::chrono::milliseconds kSecondChoiceDelay(1000);
// The pause after a session could not be resumed here.
constexpr std::chrono::milliseconds kRetryPause(10'000);

// Returns the server that should take over a session, by rendezvous hashing: every server computes the same one, and
// sessions spread evenly over the servers.
std::string PreferredServer(const std::string& id, const std::vector<std::string>& servers) {
  std::string preferred, highest;
  for (const std::string& server : servers) {
    std::string weight = Sha256Hex(absl::StrCat(id, " ", server));
    if (weight > highest) {
      highest = std::move(weight);
      preferred = server;
    }
  }
  return preferred;
}

std::vector<std::string> Texts(const Reply& reply) {
  std::vector<std::string> texts;
  texts.reserve(reply.list.size());
  for (const Reply& each : reply.list) texts.push_back(each.text);
  return texts;
}

// Parses the reply of kTakeOver. DATA_LOSS if the copy is damaged.
absl::StatusOr<store::SavedSession> ReadSaved(const std::string& id, const Reply& reply) {
  constexpr std::size_t kParts = 6;
  const absl::Status damaged = absl::DataLossError(absl::StrCat("session ", id, ": its copy in Redis is damaged"));
  if (reply.list.size() != kParts) return damaged;
  store::SavedSession saved;
  saved.id = id;
  if (!saved.scene.ParseFromString(reply.list[1].text) || !saved.moment.ParseFromString(reply.list[3].text) ||
      !saved.state.ParseFromString(reply.list[4].text) || !absl::SimpleAtoi(reply.list[2].text, &saved.sequence)) {
    return damaged;
  }
  std::map<std::int64_t, v1::SavedMoment> moments;
  const std::vector<Reply>& journal = reply.list[5].list;
  for (std::size_t i = 0; i + 1 < journal.size(); i += 2) {
    std::int64_t sequence = 0;
    if (!absl::SimpleAtoi(journal[i].text, &sequence) || !moments[sequence].ParseFromString(journal[i + 1].text)) {
      return damaged;
    }
  }
  saved.later.reserve(moments.size());
  for (auto& [sequence, moment] : moments) {
    saved.sequence = sequence;
    saved.later.push_back(std::move(moment));
  }
  return saved;
}

}  // namespace

void Cluster::Start(Hooks hooks) {
  hooks_ = std::move(hooks);
  renewal_thread_ = std::thread([this] { RenewalLoop(); });
}

void Cluster::StartTakeovers() {
  {
    absl::MutexLock lock(&mutex_);
    takes_over_ = renew_now_ = true;
  }
  takeover_thread_ = std::thread([this] { TakeoverLoop(); });
}

void Cluster::Drain() {
  {
    absl::MutexLock lock(&mutex_);
    takes_over_ = false;
    renew_now_ = true;
  }
  if (takeover_thread_.joinable()) takeover_thread_.join();
  absl::MutexLock lock(&mutex_);
  draining_ = true;
}

void Cluster::Leave() {
  {
    absl::MutexLock lock(&mutex_);
    leaving_ = true;
  }
  if (renewal_thread_.joinable()) renewal_thread_.join();
}

void Cluster::RenewalLoop() {
  pthread_setname_np(pthread_self(), "leases");
  Redis redis(redis_);
  const auto woken = [this] {
    mutex_.AssertReaderHeld();
    return leaving_ || renew_now_;
  };
  for (;;) {
    Renew(redis);
    absl::MutexLock lock(&mutex_);
    last_renewal_ = Clock::now();
    mutex_.AwaitWithTimeout(absl::Condition(&woken), kRenewalPeriod);
    renew_now_ = false;
    if (leaving_) return;
  }
}

void Cluster::Renew(Redis& redis) {
  std::vector<std::pair<std::string, std::int64_t>> leases;
  bool takes_over = false;
  {
    absl::MutexLock lock(&mutex_);
    takes_over = takes_over_;
    leases.reserve(owned_.size());
    for (const auto& [id, mine] : owned_) leases.emplace_back(id, mine.epoch);
  }
  std::vector<std::string> arguments = {address_, lease_, takes_over ? "1" : "0"};
  arguments.reserve(arguments.size() + 2 * leases.size());
  for (const auto& [id, epoch] : leases) {
    arguments.push_back(id);
    arguments.push_back(std::to_string(epoch));
  }
  const Clock::time_point requested = Clock::now();
  const int connections = redis.connections();
  const auto answers = redis.Run(kRenew, arguments);
  if (!answers.ok() || answers->list.size() != leases.size()) {
    absl::MutexLock lock(&mutex_);
    redis_reachable_ = false;
    return;
  }
  const bool reconnected = connections > 0 && redis.connections() != connections;
  const std::vector<std::string> lost = ApplyRenewal(leases, *answers, requested, reconnected);
  for (const std::string& id : lost) hooks_.lost(id);
  std::vector<std::string> incomplete;
  {
    absl::MutexLock lock(&mutex_);
    for (const auto& [id, mine] : owned_) {
      if (mine.copy_incomplete) incomplete.push_back(id);
    }
  }
  if (!incomplete.empty()) hooks_.copy_whole(incomplete);
}

std::vector<std::string> Cluster::ApplyRenewal(const std::vector<std::pair<std::string, std::int64_t>>& leases,
                                               const Reply& answers, Clock::time_point requested, bool reconnected) {
  std::vector<std::string> lost;
  absl::MutexLock lock(&mutex_);
  if (!redis_reachable_) reachable_since_ = Clock::now();
  redis_reachable_ = true;
  for (std::size_t i = 0; i < leases.size(); ++i) {
    const auto mine = owned_.find(leases[i].first);
    if (mine == owned_.end() || mine->second.epoch != leases[i].second) continue;
    const std::int64_t answer = answers.list[i].number;
    if (answer == 0) {
      lost.push_back(mine->first);
      owned_.erase(mine);
      ++lost_;
      continue;
    }
    mine->second.expires = std::max(mine->second.expires, requested + kLease);
    if (reconnected || answer == 2) mine->second.copy_incomplete = true;  // Redis may have lost the copy
  }
  return lost;
}

void Cluster::TakeoverLoop() {
  pthread_setname_np(pthread_self(), "taking-over");
  Redis redis(redis_);
  std::map<std::string, Clock::time_point> free_since;
  const auto ended = [this] {
    mutex_.AssertReaderHeld();
    return !takes_over_;
  };
  for (;;) {
    {
      absl::MutexLock lock(&mutex_);
      if (mutex_.AwaitWithTimeout(absl::Condition(&ended), kTakeoverPeriod)) return;
      // After an outage of Redis all leases have expired; gives their servers time to renew them first.
      if (!redis_reachable_ || Clock::now() < reachable_since_ + kLease) continue;
    }
    TakeOverFreeSessions(redis, free_since);
  }
}

void Cluster::TakeOverFreeSessions(Redis& redis, std::map<std::string, Clock::time_point>& free_since) {
  const auto found = redis.Run(kFindFree, {});
  if (!found.ok() || found->list.size() != 2) return;
  const std::vector<std::string> servers = Texts(found->list[1]);
  {
    absl::MutexLock lock(&mutex_);
    servers_ = servers;
  }
  std::map<std::string, Clock::time_point> still_free;
  for (const std::string& id : Texts(found->list[0])) {
    const Clock::time_point now = Clock::now();
    const auto since = free_since.find(id);
    still_free[id] = since == free_since.end() ? now : since->second;
    const bool preferred = PreferredServer(id, servers) == address_;
    if (now < still_free[id] + (preferred ? std::chrono::milliseconds(0) : kSecondChoiceDelay)) continue;
    if (!TakeOver(redis, id)) still_free[id] = now + kRetryPause;
    absl::MutexLock lock(&mutex_);
    if (!takes_over_) return;
  }
  free_since = std::move(still_free);
}

bool Cluster::TakeOver(Redis& redis, const std::string& id) {
  const Clock::time_point requested = Clock::now();
  const auto lease = redis.Run(kTakeOver, {id, address_, lease_});
  if (!lease.ok() || lease->list.empty() || lease->list[0].number <= 0) return true;  // another server was first
  const std::int64_t epoch = AddLease(id, lease->list[0].number, requested, false);
  const auto saved = ReadSaved(id, *lease);
  const absl::Status resumed = saved.ok() ? hooks_.take_over(*saved, epoch) : saved.status();
  if (!resumed.ok()) {
    Abandon(id);
    return false;
  }
  absl::MutexLock lock(&mutex_);
  owned_[id].ready = true;
  ++taken_over_;
  return true;
}

}  // namespace phrenic::cluster
