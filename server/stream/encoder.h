// Frames to bytes, each frame once a form.
#ifndef PHRENIC_SERVER_STREAM_ENCODER_H_
#define PHRENIC_SERVER_STREAM_ENCODER_H_

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <tuple>
#include <utility>
#include <vector>

#include "phrenic/v1/frames.pb.h"
#include "phrenic/v1/session.pb.h"
#include "server/stream/basis_maker.h"
#include "server/stream/codec.h"
#include "server/stream/frame.h"
#include "server/stream/viewer.h"

namespace phrenic::stream {

// Keeps the encodings of the newest snapshot it was given. Not thread-safe: the publisher's thread has it.
class Encoder {
 public:
  Encoder(std::shared_ptr<const Model> model, const Layout& layout);

  // A WatchFramesResponse with the frame in that form; null where a number of it is not finite. What the form's codec
  // cannot hold within its bound goes out raw.
  Bytes Encode(const Snapshot& snapshot, const FrameEncoding& form);
  // How often positions were encoded.
  std::int64_t encodings() const { return encodings_; }
  // The newest; null where nobody asked for CODEC_BASIS, or too little was seen.
  std::shared_ptr<const Basis> basis() const { return bases_.front(); }

 private:
  using Chosen = std::tuple<v1::Codec, std::vector<int>, std::int64_t>;  // codec, bodies, epoch of the basis

  // Makes the frame unless it is the one made last; false where it may not be sent.
  bool Make(const Snapshot& snapshot);
  void SetPositions(const FrameEncoding& form, v1::Frame& frame);
  std::shared_ptr<const Codec> FindCodec(const Chosen& chosen);
  // Shows the frame to who makes the basis, once.
  void LookForBasis(absl::Time made);
  // That of `epoch`; null where it is no longer kept.
  std::shared_ptr<const Basis> FindBasis(std::int64_t epoch) const;

  const std::shared_ptr<const Model> model_;
  const Layout& layout_;
  const std::vector<int> streamed_;
  std::int64_t sequence_ = -1;
  bool sendable_ = false;
  v1::Frame numbers_;  // without positions and poses
  std::string poses_;
  Floats positions_;  // of all streamed bodies
  std::map<FrameEncoding, Bytes> made_;
  std::map<Chosen, std::shared_ptr<const Codec>> codecs_;
  std::unique_ptr<BasisMaker> maker_;                  // since somebody asked for CODEC_BASIS
  bool shown_ = false;                                 // the present frame, to maker_
  std::array<std::shared_ptr<const Basis>, 2> bases_;  // the newest, and the one before, which viewers still have
  std::int64_t encodings_ = 0;
};

StatusUpdate EncodeSession(const v1::Session& session);
Bytes EncodeCamera(const v1::Camera& camera);

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_ENCODER_H_
