#include "server/session/compile_slots.h"

#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"

namespace phrenic::session {
namespace {

constexpr std::ptrdiff_t kMostOfAccount = 8;
constexpr std::size_t kMostInAll = 64;
constexpr absl::Duration kLook = absl::Milliseconds(50);  // between two looks at `cancelled`

}  // namespace

absl::Status CompileSlots::Enter(const std::string& account) const {
  const auto own = std::count_if(waiting_.begin(), waiting_.end(),
                                 [&account](const Waiting& each) { return each.account == account; });
  if (own < kMostOfAccount && waiting_.size() < kMostInAll) return absl::OkStatus();
  return absl::ResourceExhaustedError(absl::StrCat(own < kMostOfAccount ? waiting_.size() : own,
                                                   " scenes wait to be compiled, and no more may: try again later"));
}

int CompileSlots::Running(const Waiting& one) const {
  return static_cast<int>(std::count(running_.begin(), running_.end(), one));
}

bool CompileSlots::MayRun(const Waiting& one) const {
  const int capacity = capacity_.at(one.lane);
  const auto all =
      std::count_if(running_.begin(), running_.end(), [&one](const Waiting& each) { return each.lane == one.lane; });
  return all < capacity && Running(one) < std::max(1, capacity - 1);
}

bool CompileSlots::IsNext(Queue::const_iterator one) const {
  if (!MayRun(*one)) return false;
  const auto turn = [this](const Waiting& each) {
    mutex_.AssertHeld();
    const auto served = served_.find(each.account);
    return std::pair(Running(each), served == served_.end() ? 0 : served->second);
  };
  bool older = true;  // than this one
  for (auto other = waiting_.begin(); other != waiting_.end(); ++other) {
    if (other == one) {
      older = false;
    } else if (other->lane == one->lane && MayRun(*other)) {
      if (turn(*other) < turn(*one) || (older && turn(*other) == turn(*one))) return false;
    }
  }
  return true;
}

absl::StatusOr<CompileSlots::Slot> CompileSlots::Take(const std::string& account, Lane lane,
                                                      const std::function<bool()>& cancelled) {
  absl::MutexLock lock(&mutex_);
  if (absl::Status status = Enter(account); !status.ok()) return status;
  const auto self = waiting_.insert(waiting_.end(), Waiting{account, lane});
  const auto next = [this, self] {
    mutex_.AssertHeld();
    return IsNext(self);
  };
  while (!mutex_.AwaitWithTimeout(absl::Condition(&next), kLook)) {
    if (cancelled == nullptr || !cancelled()) continue;
    waiting_.erase(self);
    return absl::CancelledError("nobody waits for the scene any more");
  }
  running_.push_back(*self);
  waiting_.erase(self);
  served_[account] = ++turns_;
  return Slot(nullptr, [this, one = Waiting{account, lane}](void*) { GiveBack(one); });
}

void CompileSlots::GiveBack(const Waiting& one) {
  absl::MutexLock lock(&mutex_);
  running_.erase(std::find(running_.begin(), running_.end(), one));
  std::erase_if(served_, [this](const auto& served) {
    mutex_.AssertHeld();
    const auto of = [&served](const Waiting& each) { return each.account == served.first; };
    return std::none_of(waiting_.begin(), waiting_.end(), of) && std::none_of(running_.begin(), running_.end(), of);
  });
}

}  // namespace phrenic::session
