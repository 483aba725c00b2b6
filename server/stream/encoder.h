// Frames to bytes, each frame once.
#ifndef PHRENIC_SERVER_STREAM_ENCODER_H_
#define PHRENIC_SERVER_STREAM_ENCODER_H_

#include <cstdint>
#include <memory>

#include "phrenic/v1/frames.pb.h"
#include "phrenic/v1/session.pb.h"
#include "server/stream/frame.h"
#include "server/stream/viewer.h"

namespace phrenic::stream {

// Keeps the encodings of the newest snapshot it was given. Not thread-safe: the publisher's thread has it.
class Encoder {
 public:
  Encoder(std::shared_ptr<const Model> model, const Layout& layout) : model_(std::move(model)), layout_(layout) {}

  // A WatchFramesResponse with the frame; null where a number of it is not finite. Numbers are the frame without
  // positions and poses.
  Bytes Full(const Snapshot& snapshot);
  Bytes Numbers(const Snapshot& snapshot);
  // How often Full had to encode.
  std::int64_t encodings() const { return encodings_; }

 private:
  // Makes the frame unless it is the one made last; false where it may not be sent.
  bool Make(const Snapshot& snapshot);

  const std::shared_ptr<const Model> model_;
  const Layout& layout_;
  std::int64_t sequence_ = -1;
  bool sendable_ = false;
  v1::WatchFramesResponse made_;
  Bytes full_, numbers_;
  std::int64_t encodings_ = 0;
};

Bytes EncodeSession(const v1::Session& session);

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_ENCODER_H_
