#include "server/stream/encoder.h"

#include <string>
#include <utility>

namespace phrenic::stream {

bool Encoder::Make(const Snapshot& snapshot) {
  if (snapshot.sequence == sequence_) return sendable_;
  sequence_ = snapshot.sequence;
  full_ = numbers_ = nullptr;
  absl::StatusOr<v1::Frame> frame = MakeFrame(*model_, layout_, snapshot);
  sendable_ = frame.ok();
  if (sendable_) made_.mutable_frame()->Swap(&*frame);
  return sendable_;
}

Bytes Encoder::Full(const Snapshot& snapshot) {
  if (!Make(snapshot)) return nullptr;
  if (full_ == nullptr) {
    full_ = std::make_shared<const std::string>(made_.SerializeAsString());
    ++encodings_;
  }
  return full_;
}

Bytes Encoder::Numbers(const Snapshot& snapshot) {
  if (!Make(snapshot)) return nullptr;
  if (numbers_ == nullptr) {
    v1::Frame& frame = *made_.mutable_frame();
    std::string positions = std::exchange(*frame.mutable_positions(), {});
    std::string poses = std::exchange(*frame.mutable_poses(), {});
    numbers_ = std::make_shared<const std::string>(made_.SerializeAsString());
    frame.set_positions(std::move(positions));
    frame.set_poses(std::move(poses));
  }
  return numbers_;
}

Bytes EncodeSession(const v1::Session& session) {
  v1::WatchFramesResponse response;
  *response.mutable_session() = session;
  return std::make_shared<const std::string>(response.SerializeAsString());
}

}  // namespace phrenic::stream
