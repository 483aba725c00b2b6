#include "server/session/command_queue.h"

#include <utility>

namespace phrenic::session {

absl::Status CommandQueue::Call(absl::FunctionRef<void()> act) {
  bool ran = false;
  const auto run = [&] {
    act();
    ran = true;
  };
  auto done = std::make_shared<absl::Notification>();
  {
    absl::MutexLock lock(&mutex_);
    if (closed_.has_value()) return *closed_;
    commands_.push_back({.act = run, .done = done});
    called_ = true;
  }
  done->WaitForNotification();
  if (ran) return absl::OkStatus();
  absl::MutexLock lock(&mutex_);
  return closed_.value_or(absl::InternalError("the stepping thread refused a call"));
}

bool CommandQueue::Close(const absl::Status& reason) {
  absl::MutexLock lock(&mutex_);
  if (closed_.has_value()) return false;
  closed_ = reason;
  called_ = true;
  return true;
}

CommandQueue::Batch CommandQueue::Await(absl::Time deadline) {
  Batch batch;
  absl::MutexLock lock(&mutex_);
  if (!Pending() && deadline > clock_.Now()) {
    clock_.Await(mutex_, absl::Condition(this, &CommandQueue::Pending), deadline);
  }
  batch.commands.swap(commands_);
  batch.closed = closed_.has_value();
  called_ = false;
  return batch;
}

void CommandQueue::Finish(const Batch& batch) {
  for (const Command& command : batch.commands) {
    if (!batch.closed) command.act();
    command.done->Notify();
  }
}

}  // namespace phrenic::session
