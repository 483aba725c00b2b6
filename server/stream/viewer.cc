#include "server/stream/viewer.h"

#include <utility>

namespace phrenic::stream {

void Viewer::PutFrame(Bytes frame) {
  {
    absl::MutexLock lock(&mutex_);
    if (end_.has_value()) return;
    if (frame_ != nullptr) ++missed_;
    frame_ = std::move(frame);
  }
  wake_();
}

void Viewer::PutSession(Bytes session) {
  {
    absl::MutexLock lock(&mutex_);
    if (end_.has_value()) return;
    session_ = std::move(session);
  }
  wake_();
}

void Viewer::End(absl::Status reason) {
  {
    absl::MutexLock lock(&mutex_);
    if (end_.has_value()) return;
    end_ = std::move(reason);
  }
  wake_();
}

Bytes Viewer::Take() {
  absl::MutexLock lock(&mutex_);
  if (session_ != nullptr) return std::exchange(session_, nullptr);
  return std::exchange(frame_, nullptr);
}

std::optional<absl::Status> Viewer::ended() const {
  absl::MutexLock lock(&mutex_);
  if (session_ != nullptr || frame_ != nullptr) return std::nullopt;
  return end_;
}

std::int64_t Viewer::missed() const {
  absl::MutexLock lock(&mutex_);
  return missed_;
}

}  // namespace phrenic::stream
