// Sixteen bits per coordinate, low and high bytes in separate planes: for clients that do not keep the rest shape.
#ifndef PHRENIC_SERVER_STREAM_CODECS_PLANES_H_
#define PHRENIC_SERVER_STREAM_CODECS_PLANES_H_

#include "server/stream/codecs/codec.h"

namespace phrenic::stream {

// x = corner + step q, 0 <= q < 2^16, corner that of the positions' bounding box. proto/README.md specifies the bytes.
// OUT_OF_RANGE if positions lie more than 65,535 steps apart along an axis. The planes have all x first, then y and z,
// and are compressed together.
class PlanesCodec final : public Codec {
 public:
  explicit PlanesCodec(const RestShape& shape) : vertices_(shape.rest.cols()) {}
  absl::StatusOr<std::string> Encode(const Floats& positions, double max_error) const override;
  absl::StatusOr<Floats> Decode(std::string_view bytes) const override;

 private:
  const Eigen::Index vertices_;
};

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_CODECS_PLANES_H_
