#include "server/lti/outbox.h"

#include <spdlog/spdlog.h>

#include <algorithm>

#include "absl/time/clock.h"

namespace phrenic::lti {
namespace {

using nlohmann::json;

constexpr std::size_t kMostParcels = 10'000;
constexpr absl::Duration kFirstPause = absl::Seconds(1), kLongestPause = absl::Hours(1), kGiveUp = absl::Hours(7 * 24);
constexpr int kMostDoublings = 12;

absl::Duration PauseAfter(int attempts) {
  return std::min(kLongestPause, kFirstPause * (1 << std::min(attempts - 1, kMostDoublings)));
}

}  // namespace

Outbox::Outbox(Deliver deliver, jobs::Records records)
    : deliver_(std::move(deliver)), records_(std::move(records)), thread_([this] { Run(); }) {}

Outbox::~Outbox() {
  {
    absl::MutexLock lock(&mutex_);
    ended_ = true;
    changed_.Signal();
  }
  thread_.join();
}

void Outbox::Save(const Parcel& parcel) const {
  const json saved = {
      {"id", parcel.id},           {"receiver", parcel.receiver}, {"address", parcel.address},
      {"content", parcel.content}, {"attempts", parcel.attempts}, {"first", absl::ToUnixSeconds(parcel.first)}};
  records_.Put(parcel.id, saved.dump());
}

void Outbox::Add(Parcel parcel, absl::Time now) {
  absl::MutexLock lock(&mutex_);
  if (waiting_.size() >= kMostParcels && !waiting_.contains(parcel.id)) {
    spdlog::error("lti: {} messages wait for other servers, and no more are kept: one was lost", kMostParcels);
    return;
  }
  parcel.first = now;
  Save(parcel);
  std::string id = parcel.id;
  waiting_[std::move(id)] = {std::move(parcel), absl::InfinitePast(), ++versions_};
  changed_.Signal();
}

absl::Status Outbox::Restore(const std::string& bytes) {
  const json saved = json::parse(bytes, nullptr, false);
  const auto text = [&](const char* name) {
    return saved.contains(name) && saved[name].is_string() ? saved[name].get<std::string>() : "";
  };
  if (!saved.is_object() || text("id").empty() || !saved.contains("content") || !saved.contains("first") ||
      !saved["first"].is_number_integer()) {
    return absl::InvalidArgumentError("is no message");
  }
  absl::MutexLock lock(&mutex_);
  Parcel parcel{text("id"),
                text("receiver"),
                text("address"),
                saved["content"],
                0,
                absl::FromUnixSeconds(saved["first"].get<std::int64_t>())};
  waiting_[parcel.id] = {parcel, absl::InfinitePast(), ++versions_};
  changed_.Signal();
  return absl::OkStatus();
}

std::size_t Outbox::size() const {
  absl::MutexLock lock(&mutex_);
  return waiting_.size();
}

std::map<std::string, Outbox::Waiting>::iterator Outbox::Next() {
  return std::min_element(waiting_.begin(), waiting_.end(), [](const auto& a, const auto& b) {
    return std::pair(a.second.due, a.second.version) < std::pair(b.second.due, b.second.version);
  });
}

void Outbox::Settle(const Waiting& tried, const absl::Status& outcome) {
  absl::MutexLock lock(&mutex_);
  const auto found = waiting_.find(tried.parcel.id);
  if (found == waiting_.end() || found->second.version != tried.version) return;  // a newer one waits
  Parcel& parcel = found->second.parcel;
  const absl::Time now = absl::Now();
  const bool refused = absl::IsInvalidArgument(outcome), old = now - parcel.first > kGiveUp;
  if (outcome.ok() || refused || old) {
    if (!outcome.ok()) spdlog::error("lti: a message was not accepted and is lost: {}", std::string(outcome.message()));
    records_.Remove(parcel.id);
    waiting_.erase(found);
    return;
  }
  ++parcel.attempts;
  found->second.due = now + PauseAfter(parcel.attempts);
  spdlog::warn("lti: a message did not arrive and is sent again later: {}", std::string(outcome.message()));
}

void Outbox::Run() {
  for (;;) {
    Waiting tried;
    {
      absl::MutexLock lock(&mutex_);
      while (!ended_ && (waiting_.empty() || Next()->second.due > absl::Now())) {
        changed_.WaitWithDeadline(&mutex_, waiting_.empty() ? absl::InfiniteFuture() : Next()->second.due);
      }
      if (ended_) return;
      tried = Next()->second;
    }
    Settle(tried, deliver_(tried.parcel));
  }
}

}  // namespace phrenic::lti
