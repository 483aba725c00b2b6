#include "server/service/watch/claimed_watch.h"

#include <utility>

#include "server/service/calls/status.h"
#include "server/service/watch/watch_claims.h"

namespace phrenic::service {

absl::Status ClaimedWatch::Start(std::shared_ptr<session::Session> session, const stream::ViewerOptions& options,
                                 WatchStream::Subscription subscription, const std::string& key, WatchClaims& claims) {
  const auto self = shared_from_this();
  absl::Status joined = watch_.Join(std::move(session), options, std::move(subscription), [weak = weak_from_this()] {
    if (const auto watch = weak.lock()) watch->CallReady();
  });
  if (!joined.ok()) return joined;
  call_.Continue(self);
  watch_.Begin();
  if (!claims.Give(key, self)) OnCancel();
  return absl::OkStatus();
}

void ClaimedWatch::set_ready(std::function<void()> ready) {
  absl::MutexLock lock(&ready_mutex_);
  ready_ = std::move(ready);
}

void ClaimedWatch::CallReady() {
  absl::MutexLock lock(&ready_mutex_);
  if (ready_) ready_();
}

stream::Bytes ClaimedWatch::Take() {
  WatchStream::Next next = watch_.Take();
  if (next.end.has_value()) Finish(*next.end);
  return std::move(next.message);
}

// Ends at once, also while a message is in flight: the socket that it is written to may be stuck.
void ClaimedWatch::OnCancel() {
  watch_.Cancel();
  Finish(absl::CancelledError());
}

void ClaimedWatch::Finish(const absl::Status& status) {
  {
    absl::MutexLock lock(&finish_mutex_);
    if (std::exchange(finished_, true)) return;
  }
  call_.FinishOnce(ToGrpc(status));
}

}  // namespace phrenic::service
