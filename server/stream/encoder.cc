#include "server/stream/encoder.h"

#include <string>

#include "server/stream/rest_shape.h"

namespace phrenic::stream {
namespace {

constexpr std::size_t kMostCodecs = 8;  // cached, one per selection of bodies

}  // namespace

Encoder::Encoder(std::shared_ptr<const Model> model, const Layout& layout)
    : model_(std::move(model)), layout_(layout), streamed_(StreamedBodies(*model_, layout)) {}

bool Encoder::Make(const Snapshot& snapshot) {
  if (snapshot.sequence == sequence_) return sendable_;
  sequence_ = snapshot.sequence;
  made_.clear();
  shown_ = false;
  absl::StatusOr<v1::Frame> frame = MakeFrame(*model_, layout_, snapshot, scratch_);
  sendable_ = frame.ok();
  if (!sendable_) return false;
  numbers_.Swap(&*frame);
  positions_ =
      Eigen::Map<const Floats>(reinterpret_cast<const float*>(numbers_.positions().data()), 3, layout_.vertices());
  numbers_.clear_positions();
  poses_ = std::move(*numbers_.mutable_poses());
  numbers_.clear_poses();
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
  const std::vector<int>& bodies = encoding.chosen ? encoding.bodies : streamed_;
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
  v1::WatchFramesResponse response;
  *response.mutable_frame() = numbers_;
  if (encoding.codec == v1::CODEC_BASIS) LookForBasis(snapshot.made);
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
