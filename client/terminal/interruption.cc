#include "client/terminal/interruption.h"

#include <csignal>
#include <thread>

namespace phrenic::client {
namespace {

sigset_t Signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  return signals;
}

}  // namespace

Interruption::Interruption() {
  const sigset_t signals = Signals();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);  // threads inherit the mask
  std::thread([this] { Wait(); }).detach();
}

void Interruption::Wait() {
  const sigset_t signals = Signals();
  int signal = 0;
  while (sigwait(&signals, &signal) == 0) {
    const absl::MutexLock lock(&mutex_);
    if (happened_) std::_Exit(130);  // the second signal ends the process at once
    happened_ = true;
    if (call_ != nullptr) call_->TryCancel();
  }
}

bool Interruption::happened() const {
  const absl::MutexLock lock(&mutex_);
  return happened_;
}

Interruption::Scope::Scope(Interruption& interruption, grpc::ClientContext& context) : interruption_(interruption) {
  const absl::MutexLock lock(&interruption_.mutex_);
  interruption_.call_ = &context;
  if (interruption_.happened_) context.TryCancel();
}

Interruption::Scope::~Scope() {
  const absl::MutexLock lock(&interruption_.mutex_);
  interruption_.call_ = nullptr;
}

}  // namespace phrenic::client
