#include "server/service/calls/fair_share.h"

#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"

namespace phrenic::service {

bool FairShare::HasRoom(const std::string& name, const Caller& caller) const {
  return held_ < limits_.in_all && (name.empty() || caller.held < limits_.of_caller);
}

void FairShare::Tidy(const std::string& name) {
  const auto found = callers_.find(name);
  if (found != callers_.end() && found->second.held == 0 && found->second.waiting.empty()) callers_.erase(found);
}

FairShare::Hold FairShare::MakeHold(const std::string& caller) {
  return {this, [this, caller](void*) { Release(caller); }};
}

absl::StatusOr<FairShare::Hold> FairShare::Take(const std::string& caller) {
  absl::MutexLock lock(&mutex_);
  Caller& entry = callers_[caller];
  if (HasRoom(caller, entry)) {
    ++held_, ++entry.held;
    return MakeHold(caller);
  }
  const bool own = held_ < limits_.in_all;
  Tidy(caller);
  return absl::ResourceExhaustedError(
      absl::StrCat(own ? "you have " : "there are ", own ? limits_.of_caller : limits_.in_all, " ", limits_.what,
                   own ? ", the most that one caller may have (" : ", which is the limit (", limits_.setting,
                   "); end one, or try again later"));
}

absl::StatusOr<std::uint64_t> FairShare::Enter(const std::string& caller, Granted granted) {
  std::uint64_t ticket = 0;
  {
    absl::MutexLock lock(&mutex_);
    Caller& entry = callers_[caller];
    const bool must_wait = !entry.waiting.empty() || !HasRoom(caller, entry);
    if (must_wait && static_cast<int>(entry.waiting.size()) >= limits_.waiting_of_caller) {
      Tidy(caller);
      return absl::ResourceExhaustedError(absl::StrCat(limits_.what, ": ", limits_.waiting_of_caller,
                                                       " of this caller wait already, which is the limit (",
                                                       limits_.setting, "); wait for answers before you send more"));
    }
    if (entry.waiting.empty()) turns_.push_back(caller);
    ticket = ++tickets_;
    entry.waiting.push_back({ticket, std::move(granted)});
  }
  Grant();
  return ticket;
}

bool FairShare::Withdraw(const std::string& caller, std::uint64_t ticket) {
  absl::MutexLock lock(&mutex_);
  const auto entry = callers_.find(caller);
  if (entry == callers_.end()) return false;
  std::deque<Waiting>& waiting = entry->second.waiting;
  const auto found =
      std::find_if(waiting.begin(), waiting.end(), [ticket](const Waiting& each) { return each.ticket == ticket; });
  if (found == waiting.end()) return false;
  waiting.erase(found);
  if (waiting.empty()) turns_.erase(std::find(turns_.begin(), turns_.end(), caller));
  Tidy(caller);
  return true;
}

FairShare::Granted FairShare::TakeNext(std::string& caller) {
  const auto next = std::find_if(turns_.begin(), turns_.end(), [this](const std::string& name) {
    mutex_.AssertHeld();
    return HasRoom(name, callers_[name]);
  });
  if (next == turns_.end()) return nullptr;
  caller = *next;
  turns_.erase(next);
  Caller& entry = callers_[caller];
  Granted granted = std::move(entry.waiting.front().granted);
  entry.waiting.pop_front();
  if (!entry.waiting.empty()) turns_.push_back(caller);
  ++held_, ++entry.held;
  return granted;
}

void FairShare::Grant() {
  for (;;) {
    std::string caller;
    Granted granted;
    {
      absl::MutexLock lock(&mutex_);
      granted = TakeNext(caller);
    }
    if (!granted) return;
    granted(MakeHold(caller));
  }
}

void FairShare::Release(const std::string& caller) {
  {
    absl::MutexLock lock(&mutex_);
    --held_, --callers_[caller].held;
    Tidy(caller);
  }
  Grant();
}

}  // namespace phrenic::service
