#include "server/service/watch/watch_stream.h"

#include <utility>

#include "absl/time/clock.h"

namespace phrenic::service {

absl::Status WatchStream::Join(std::shared_ptr<session::Session> session, const stream::ViewerOptions& options,
                               Subscription subscription, std::function<void()> ready) {
  auto viewer = session->publisher().Join(options, std::move(ready));
  if (!viewer.ok()) return viewer.status();
  absl::MutexLock lock(&mutex_);
  subscription_ = std::move(subscription);
  session_ = std::move(session);
  viewer_ = *std::move(viewer);
  return absl::OkStatus();
}

void WatchStream::Begin() {
  absl::MutexLock lock(&mutex_);
  begun_ = true;
}

WatchStream::Next WatchStream::Take() {
  absl::MutexLock lock(&mutex_);
  if (viewer_ == nullptr || !begun_ || in_flight_ || ended_) return {};
  Next next;
  next.end = cancelled_ ? absl::CancelledError() : viewer_->ended();
  if (!next.end.has_value() && subscription_.may_see && !subscription_.may_see()) {
    next.end = absl::PermissionDeniedError("authorization: you may no longer watch this session; ask its owner");
  }
  ended_ = next.end.has_value();
  if (ended_) return next;
  next.message = viewer_->Take(absl::Now());
  in_flight_ = next.message != nullptr;
  if (in_flight_ && subscription_.sent) subscription_.sent(next.message->size());
  return next;
}

void WatchStream::NoteSent() {
  absl::MutexLock lock(&mutex_);
  in_flight_ = false;
}

void WatchStream::Cancel() {
  absl::MutexLock lock(&mutex_);
  cancelled_ = true;
}

void WatchStream::Leave() {
  // Releases the session here: a publisher that calls `ready` must not destroy its own session.
  std::shared_ptr<session::Session> session;
  std::shared_ptr<stream::Viewer> viewer;
  Subscription subscription;
  {
    absl::MutexLock lock(&mutex_);
    session = std::move(session_);
    viewer = std::move(viewer_);
    subscription = std::exchange(subscription_, {});
  }
  if (session != nullptr) session->publisher().Leave(viewer);
}

}  // namespace phrenic::service
