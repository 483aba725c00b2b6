// Keeping leases, and taking over what nobody has a lease on.
#include <pthread.h>

#include <algorithm>
#include <utility>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "server/cluster/cluster.h"
#include "server/cluster/scripts.h"
#include "server/schema/sha256.h"

namespace phrenic::cluster {
namespace {

constexpr absl::Duration kRenewPause = absl::Milliseconds(700), kLookPause = absl::Milliseconds(150);
// How much longer than the server that a free session falls to the others wait for it.
constexpr std::chrono::milliseconds kCourtesy(1000);
// Until a session that could not be gone on with here is tried again.
constexpr std::chrono::milliseconds kAgain(10'000);

// Which of the servers a session falls to, where nobody has it: each its share, and whoever asks comes to the same.
std::string HeirOf(const std::string& id, const std::vector<std::string>& servers) {
  std::string heir, most;
  for (const std::string& server : servers) {
    std::string weight = Sha256Hex(absl::StrCat(id, " ", server));
    if (weight > most) {
      most = std::move(weight);
      heir = server;
    }
  }
  return heir;
}

std::vector<std::string> Texts(const Reply& reply) {
  std::vector<std::string> texts;
  texts.reserve(reply.list.size());
  for (const Reply& each : reply.list) texts.push_back(each.text);
  return texts;
}

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

void Cluster::Begin(Hooks hooks) {
  hooks_ = std::move(hooks);
  renewing_ = std::thread([this] { KeepRenewing(); });
}

void Cluster::Watch() {
  {
    absl::MutexLock lock(&mutex_);
    takes_ = hurry_ = true;
  }
  looking_ = std::thread([this] { KeepLooking(); });
}

void Cluster::Rest() {
  {
    absl::MutexLock lock(&mutex_);
    takes_ = false;
    hurry_ = true;
  }
  if (looking_.joinable()) looking_.join();
  absl::MutexLock lock(&mutex_);
  resting_ = true;
}

void Cluster::Leave() {
  {
    absl::MutexLock lock(&mutex_);
    leaving_ = true;
  }
  if (renewing_.joinable()) renewing_.join();
}

void Cluster::KeepRenewing() {
  pthread_setname_np(pthread_self(), "leases");
  Redis redis(redis_);
  const auto stirred = [this] {
    mutex_.AssertReaderHeld();
    return leaving_ || hurry_;
  };
  for (;;) {
    Renew(redis);
    absl::MutexLock lock(&mutex_);
    tried_ = Clock::now();
    mutex_.AwaitWithTimeout(absl::Condition(&stirred), kRenewPause);
    hurry_ = false;
    if (leaving_) return;
  }
}

void Cluster::Renew(Redis& redis) {
  std::vector<std::pair<std::string, std::int64_t>> own;
  bool takes = false;
  {
    absl::MutexLock lock(&mutex_);
    takes = takes_;
    own.reserve(own_.size());
    for (const auto& [id, mine] : own_) own.emplace_back(id, mine.epoch);
  }
  std::vector<std::string> words = {address_, lease_, takes ? "1" : "0"};
  words.reserve(words.size() + 2 * own.size());
  for (const auto& [id, epoch] : own) {
    words.push_back(id);
    words.push_back(std::to_string(epoch));
  }
  const Clock::time_point asked = Clock::now();
  const int before = redis.connections();
  const auto answers = redis.Run(kRenew, words);
  if (!answers.ok() || answers->list.size() != own.size()) {
    absl::MutexLock lock(&mutex_);
    reached_ = false;
    return;
  }
  const bool anew = before > 0 && redis.connections() != before;
  const std::vector<std::string> lost = NoteRenewed(own, *answers, asked, anew);
  for (const std::string& id : lost) hooks_.lost(id);
  std::vector<std::string> behind;
  {
    absl::MutexLock lock(&mutex_);
    for (const auto& [id, mine] : own_) {
      if (mine.behind) behind.push_back(id);
    }
  }
  if (!behind.empty()) hooks_.copy_whole(behind);
}

std::vector<std::string> Cluster::NoteRenewed(const std::vector<std::pair<std::string, std::int64_t>>& own,
                                              const Reply& answers, Clock::time_point asked, bool anew) {
  std::vector<std::string> lost;
  absl::MutexLock lock(&mutex_);
  if (!reached_) reached_since_ = Clock::now();
  reached_ = true;
  for (std::size_t i = 0; i < own.size(); ++i) {
    const auto mine = own_.find(own[i].first);
    if (mine == own_.end() || mine->second.epoch != own[i].second) continue;
    const std::int64_t answer = answers.list[i].number;
    if (answer == 0) {
      lost.push_back(mine->first);
      own_.erase(mine);
      ++lost_;
      continue;
    }
    mine->second.until = std::max(mine->second.until, asked + kLease);
    if (anew || answer == 2) mine->second.behind = true;  // what it had may be gone
  }
  return lost;
}

void Cluster::KeepLooking() {
  pthread_setname_np(pthread_self(), "taking-over");
  Redis redis(redis_);
  std::map<std::string, Clock::time_point> free;
  const auto ended = [this] {
    mutex_.AssertReaderHeld();
    return !takes_;
  };
  for (;;) {
    {
      absl::MutexLock lock(&mutex_);
      if (mutex_.AwaitWithTimeout(absl::Condition(&ended), kLookPause)) return;
      // After Redis was gone every lease is over: their servers renew them first.
      if (!reached_ || Clock::now() < reached_since_ + kLease) continue;
    }
    Look(redis, free);
  }
}

void Cluster::Look(Redis& redis, std::map<std::string, Clock::time_point>& free) {
  const auto look = redis.Run(kLook, {});
  if (!look.ok() || look->list.size() != 2) return;
  const std::vector<std::string> servers = Texts(look->list[1]);
  {
    absl::MutexLock lock(&mutex_);
    servers_ = servers;
  }
  std::map<std::string, Clock::time_point> still;
  for (const std::string& id : Texts(look->list[0])) {
    const Clock::time_point now = Clock::now();
    const auto since = free.find(id);
    still[id] = since == free.end() ? now : since->second;
    if (now < still[id] + (HeirOf(id, servers) == address_ ? std::chrono::milliseconds(0) : kCourtesy)) continue;
    if (!Take(redis, id)) still[id] = now + kAgain;
    absl::MutexLock lock(&mutex_);
    if (!takes_) return;
  }
  free = std::move(still);
}

bool Cluster::Take(Redis& redis, const std::string& id) {
  const Clock::time_point asked = Clock::now();
  const auto taken = redis.Run(kTake, {id, address_, lease_});
  if (!taken.ok() || taken->list.empty() || taken->list[0].number <= 0) return true;  // another one was first
  const std::int64_t epoch = Hold(id, taken->list[0].number, asked, false);
  const auto saved = ReadSaved(id, *taken);
  const absl::Status gone_on = saved.ok() ? hooks_.take_over(*saved, epoch) : saved.status();
  if (!gone_on.ok()) {
    Abandon(id);
    return false;
  }
  absl::MutexLock lock(&mutex_);
  own_[id].ready = true;
  ++taken_;
  return true;
}

}  // namespace phrenic::cluster
