// Encodes frames to bytes, each frame once per FrameEncoding.
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
#include "server/stream/codecs/codec.h"
#include "server/stream/frame.h"
#include "server/stream/viewer.h"

namespace phrenic::stream {

// Caches the encodings of the newest snapshot. Not thread-safe: only the publisher's thread calls it. Publisher owns
// it. It keeps at most nine codecs, each with its rest shape.
class Encoder {
 public:
  // `layout` is that of `model` and outlives the encoder.
  Encoder(std::shared_ptr<const Model> model, const Layout& layout);

  // Returns a WatchFramesResponse with the frame in that encoding; null if a number of the frame is not finite. A body
  // is placed once, and only if an encoding of the snapshot has it.
  // Positions that the codec cannot encode within the bound are encoded with CODEC_RAW. A snapshot with another
  // sequence number replaces the cached one. Without a basis of the requested epoch, CODEC_BASIS becomes
  // CODEC_PREDICTED. The frame names the codec and the bound that it has.
  Bytes Encode(const Snapshot& snapshot, const FrameEncoding& encoding);
  // Returns the number of position encodings so far.
  std::int64_t encodings() const { return encodings_; }
  // Returns how often a body was placed so far.
  std::int64_t placements() const { return placements_; }
  // Returns the newest basis; null if no viewer requested CODEC_BASIS or there were too few frames.
  std::shared_ptr<const Basis> basis() const { return bases_.front(); }

 private:
  using Chosen = std::tuple<v1::Codec, std::vector<int>, std::int64_t>;  // codec, bodies, epoch of the basis

  // Makes the frame without positions unless it is cached. Returns false if it has numbers that are not finite.
  bool Make(const Snapshot& snapshot);
  // Sets the positions of those bodies that have none yet in the current frame. Returns false if one is not finite.
  bool Place(const State& state, const std::vector<int>& bodies);
  const std::vector<int>& BodiesOf(const FrameEncoding& encoding) const {
    return encoding.chosen ? encoding.bodies : streamed_;
  }
  // Writes codec, bound [mm], positions and poses.
  void SetPositions(const FrameEncoding& encoding, v1::Frame& frame);
  // Returns a cached codec or makes one.
  std::shared_ptr<const Codec> FindCodec(const Chosen& chosen);
  // Passes the frame to the basis maker, once.
  void LookForBasis(absl::Time made);
  // Returns the basis of `epoch`; null if it is no longer kept.
  std::shared_ptr<const Basis> FindBasis(std::int64_t epoch) const;

  const std::shared_ptr<const Model> model_;
  const Layout& layout_;
  const std::vector<int> streamed_;      // indices of bodies, ascending
  std::int64_t sequence_ = -1;           // of the cached snapshot
  bool sendable_ = false;                // its numbers are finite
  const Scratch scratch_;                // of frames
  v1::Frame numbers_;                    // without positions and poses
  std::string poses_;                    // encoded
  std::vector<bool> placed_;             // by body: positions_ has those of the cached snapshot
  Floats positions_;                     // of all streamed bodies
  std::map<FrameEncoding, Bytes> made_;  // of the cached snapshot
  std::map<Chosen, std::shared_ptr<const Codec>> codecs_;
  std::unique_ptr<BasisMaker> maker_;                  // from the first request for CODEC_BASIS
  bool shown_ = false;                                 // true if maker_ has the current frame
  std::array<std::shared_ptr<const Basis>, 2> bases_;  // the newest and the previous one, which viewers may still use
  std::int64_t encodings_ = 0, placements_ = 0;
};

// Return a WatchFramesResponse with the status or the camera. Thread-safe.
StatusUpdate EncodeSession(const v1::Session& session);
Bytes EncodeCamera(const v1::Camera& camera);

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_ENCODER_H_
