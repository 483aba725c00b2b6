#include "server/stream/viewer.h"

#include <utility>

#include "absl/strings/str_cat.h"

namespace phrenic::stream {

FrameEncoding Viewer::encoding() const {
  absl::MutexLock lock(&mutex_);
  FrameEncoding encoding = options_.encoding;
  encoding.bound_level = credit_.bound_level();
  if (encoding.codec == v1::CODEC_BASIS) encoding.basis_epoch = basis_epoch_;
  return encoding;
}

bool Viewer::deferred() const {
  absl::MutexLock lock(&mutex_);
  return deferred_;
}

void Viewer::Wait(std::int64_t sequence, absl::Time now) {
  if ((frame_ != nullptr || deferred_) && sequence_ != sequence) {
    ++missed_;
    credit_.Missed(now);
  }
  sequence_ = sequence;
}

bool Viewer::Defer(std::int64_t sequence, absl::Time now) {
  absl::MutexLock lock(&mutex_);
  if (credit_.MaySend()) return false;
  Wait(sequence, now);
  frame_ = nullptr;
  deferred_ = true;
  return true;
}

void Viewer::PutFrame(std::int64_t sequence, Bytes frame, absl::Time now) {
  {
    absl::MutexLock lock(&mutex_);
    if (end_.has_value()) return;
    Wait(sequence, now);
    frame_ = std::move(frame);
    deferred_ = false;
  }
  wake_();
}

void Viewer::PutSession(const StatusUpdate& updates) {
  {
    absl::MutexLock lock(&mutex_);
    if (end_.has_value()) return;
    if (!updates_.empty() && updates_.back().revision == updates.revision) {
      updates_.back() = updates;
    } else if (updates_.size() < kMaxUpdates) {
      updates_.push_back(updates);
    } else {
      updates_.clear();
      frame_ = nullptr;
      camera_ = nullptr;
      end_ = absl::ResourceExhaustedError(
          absl::StrCat("the viewer took none of ", kMaxUpdates, " changes of the session; watch again"));
    }
  }
  wake_();
}

void Viewer::PutCamera(Bytes camera) {
  {
    absl::MutexLock lock(&mutex_);
    if (end_.has_value()) return;
    camera_ = std::move(camera);
  }
  wake_();
}

void Viewer::End(absl::Status reason) {
  {
    absl::MutexLock lock(&mutex_);
    if (end_.has_value()) return;
    end_ = std::move(reason);
    if (!credit_.MaySend()) frame_ = nullptr;
  }
  wake_();
}

Bytes Viewer::Take(absl::Time now) {
  absl::MutexLock lock(&mutex_);
  if (!updates_.empty()) {
    Bytes bytes = std::move(updates_.front().bytes);
    updates_.pop_front();
    return bytes;
  }
  if (camera_ != nullptr) return std::exchange(camera_, nullptr);
  if (frame_ == nullptr || !credit_.MaySend()) return nullptr;
  credit_.Sent(sequence_, now);
  return std::exchange(frame_, nullptr);
}

v1::AckFramesResponse Viewer::Acknowledge(std::int64_t sequence, std::int64_t basis_epoch, absl::Time now) {
  v1::AckFramesResponse response;
  {
    absl::MutexLock lock(&mutex_);
    credit_.Acknowledged(sequence, now);
    basis_epoch_ = basis_epoch;
    response.set_unix_nanos(absl::ToUnixNanos(now));
    response.set_frames_per_second(credit_.FramesPerSecond(now));
    response.set_max_error_mm(options_.encoding.codec == v1::CODEC_RAW ? 0 : BoundMillimetres(credit_.bound_level()));
    response.set_max_unacked_frames(credit_.allowed());
  }
  wake_();
  return response;
}

std::optional<absl::Status> Viewer::ended() const {
  absl::MutexLock lock(&mutex_);
  if (!updates_.empty() || camera_ != nullptr || frame_ != nullptr) return std::nullopt;
  return end_;
}

std::int64_t Viewer::missed() const {
  absl::MutexLock lock(&mutex_);
  return missed_;
}

}  // namespace phrenic::stream
