// Lossless float32: for clients without a decoder, and for positions that other codecs cannot encode.
#ifndef PHRENIC_SERVER_STREAM_CODECS_RAW_H_
#define PHRENIC_SERVER_STREAM_CODECS_RAW_H_

#include "server/stream/codecs/codec.h"

namespace phrenic::stream {

// x, y, z per vertex. Little-endian, 12 bytes per vertex. Encode never fails and ignores `max_error`.
class RawCodec final : public Codec {
 public:
  explicit RawCodec(const RestShape& shape) : vertices_(shape.rest.cols()) {}
  absl::StatusOr<std::string> Encode(const Floats& positions, double max_error) const override;
  absl::StatusOr<Floats> Decode(std::string_view bytes) const override;

 private:
  const Eigen::Index vertices_;
};

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_CODECS_RAW_H_
