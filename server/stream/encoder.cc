#include "server/stream/encoder.h"

#include <algorithm>
#include <iterator>
#include <string>

#include "server/stream/rest_shape.h"

namespace phrenic::stream {
namespace {

constexpr std::size_t kMostCodecs = 8;  // cached, one per selection of bodies

}  // namespace

Encoder::Encoder(std::shared_ptr<const Model> model, const Layout& layout)
    : model_(std::move(model)),
      layout_(layout),
      streamed_(StreamedBodies(*model_, layout)),
      placed_(model_->bodies.size()),
      positions_(3, layout.vertices()) {}

bool Encoder::Make(const Snapshot& snapshot) {
  if (snapshot.sequence == sequence_) return sendable_;
  sequence_ = snapshot.sequence;
  made_.clear();
  shown_ = false;
  placed_.assign(placed_.size(), false);
  absl::StatusOr<v1::Frame> frame = MakeNumbers(*model_, snapshot, scratch_);
  sendable_ = frame.ok();
  if (!sendable_) return false;
  numbers_.Swap(&*frame);
  poses_ = std::move(*numbers_.mutable_poses());
  numbers_.clear_poses();
  return true;
}

bool Encoder::Place(const State& state, const std::vector<int>& bodies) {
  std::vector<int> missing;
  std::ranges::copy_if(bodies, std::back_inserter(missing), [&](int body) { return !placed_[body]; });
  if (missing.empty()) return true;
  if (!PlaceBodies(*model_, layout_, state, missing, positions_.data(), scratch_).ok()) return false;
  for (const int body : missing) placed_[body] = true;
  placements_ += static_cast<std::int64_t>(missing.size());
  return true;
}

std::shared_ptr<const Codec> Encoder::FindCodec(const Chosen& chosen) {
  if (codecs_.size() > kMostCodecs) codecs_.clear();
  std::shared_ptr<const Codec>& codec = codecs_[chosen];
  if (codec != nullptr) return codec;
  const auto& [kind, bodies, epoch] = chosen;
  RestShape shape = MakeRestShape(*model_, bodies);
  if (const auto basis = FindBasis(epoch); basis != nullptr) {
    for (const Floats& each : basis->shapes) shape.shapes.push_back(Pick(*model_, layout_, bodies, each));
  }
  codec = MakeCodec(kind, shape);
  return codec;
}

std::shared_ptr<const Basis> Encoder::FindBasis(std::int64_t epoch) const {
  for (const auto& basis : bases_) {
    if (basis != nullptr && basis->epoch == epoch) return basis;
  }
  return nullptr;
}

void Encoder::LookForBasis(absl::Time made) {
  if (std::exchange(shown_, true)) return;
  if (maker_ == nullptr) {
    maker_ =
        std::make_unique<BasisMaker>(MakeRestShape(*model_, streamed_), FindCodec({v1::CODEC_PREDICTED, streamed_, 0}));
  }
  maker_->See(positions_, made);
  if (maker_->newest() != bases_.front()) bases_ = {maker_->newest(), bases_.front()};
}

void Encoder::SetPositions(const FrameEncoding& encoding, v1::Frame& frame) {
  const std::vector<int>& bodies = BodiesOf(encoding);
  const bool all = bodies == streamed_;
  const Floats picked = all ? Floats() : Pick(*model_, layout_, bodies, positions_);
  const Floats& positions = all ? positions_ : picked;
  const bool put_together = encoding.codec == v1::CODEC_BASIS && FindBasis(encoding.basis_epoch) != nullptr;
  const v1::Codec codec = encoding.codec == v1::CODEC_BASIS && !put_together ? v1::CODEC_PREDICTED : encoding.codec;
  const std::int64_t epoch = put_together ? encoding.basis_epoch : 0;
  const double bound = codec == v1::CODEC_RAW ? 0 : BoundMillimetres(encoding.bound_level);
  frame.set_codec(codec);
  frame.set_max_error_mm(bound);
  frame.set_basis_epoch(epoch);
  auto bytes = FindCodec({codec, bodies, epoch})->Encode(positions, 1e-3 * bound);
  if (!bytes.ok()) {
    frame.set_codec(v1::CODEC_RAW);
    frame.set_max_error_mm(0);
    frame.set_basis_epoch(0);
    bytes = FindCodec({v1::CODEC_RAW, bodies, 0})->Encode(positions, 0);
  }
  frame.set_positions(*std::move(bytes));  // CODEC_RAW never fails
  frame.mutable_bodies()->Assign(bodies.begin(), bodies.end());
  frame.set_poses(poses_);
  ++encodings_;
}

Bytes Encoder::Encode(const Snapshot& snapshot, const FrameEncoding& encoding) {
  if (!Make(snapshot)) return nullptr;
  Bytes& bytes = made_[encoding];
  if (bytes != nullptr) return bytes;
  if (!encoding.numbers_only && !Place(snapshot.state, BodiesOf(encoding))) return nullptr;
  v1::WatchFramesResponse response;
  *response.mutable_frame() = numbers_;
  if (encoding.codec == v1::CODEC_BASIS && Place(snapshot.state, streamed_)) LookForBasis(snapshot.made);
  if (!encoding.numbers_only) SetPositions(encoding, *response.mutable_frame());
  bytes = std::make_shared<const std::string>(response.SerializeAsString());
  return bytes;
}

StatusUpdate EncodeSession(const v1::Session& session) {
  v1::WatchFramesResponse response;
  *response.mutable_session() = session;
  return {.revision = session.revision(), .bytes = std::make_shared<const std::string>(response.SerializeAsString())};
}

Bytes EncodeCamera(const v1::Camera& camera) {
  v1::WatchFramesResponse response;
  *response.mutable_camera() = camera;
  return std::make_shared<const std::string>(response.SerializeAsString());
}

}  // namespace phrenic::stream
