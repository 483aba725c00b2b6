// Codecs: vertex positions to bytes and back. One codec a file in codecs/, one row a codec in codecs.cc.
#ifndef PHRENIC_SERVER_STREAM_CODECS_CODEC_H_
#define PHRENIC_SERVER_STREAM_CODECS_CODEC_H_

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "phrenic/v1/frames.pb.h"
#include "server/mesh/mesh.h"
#include "server/stream/decoder/rest_mesh.h"

namespace phrenic::stream {

using Floats = Eigen::Matrix3Xf;  // 3 x n [m], one column per vertex

// What server and viewer know of the streamed vertices from the geometry. Both make the same one, bit for bit, since
// codecs predict from it.
struct RestShape {
  Floats rest;                      // float32, as the geometry has them
  Edges edges;                      // pairs of neighbouring vertices
  std::vector<Floats> shapes = {};  // displacement shapes of CODEC_BASIS [m]
};

// The rest shape as the decoder takes it. It refers to `shape`.
inline RestMesh MeshOf(const RestShape& shape) {
  return {.rest = {shape.rest.data(), static_cast<std::size_t>(shape.rest.size())},
          .edges = {shape.edges.data(), static_cast<std::size_t>(shape.edges.size())}};
}

// An encoding needs only the rest shape, no other frame. Immutable; thread-safe.
class Codec {
 public:
  virtual ~Codec() = default;
  // Encodes positions so that every decoded vertex lies within `max_error` [m] of the original. Requires: `positions`
  // are finite, 3 x the vertices at rest. OUT_OF_RANGE if the codec cannot meet the bound: the positions span too large
  // a range, or the bound is finer than float32.
  virtual absl::StatusOr<std::string> Encode(const Floats& positions, double max_error) const = 0;
  // Returns finite positions for any bytes, or INVALID_ARGUMENT if they do not encode that number of vertices: by the
  // decoder of viewers (decoder/position_decoder.h), which is set up in each call.
  virtual absl::StatusOr<Floats> Decode(std::string_view bytes) const = 0;
};

// Codecs() owns the rows; they live as long as the process.
struct CodecRow {
  v1::Codec codec;
  std::string_view name;  // in commands, such as "raw"
  std::unique_ptr<Codec> (*make)(const RestShape& shape);
};

// One row a codec, CODEC_RAW first.
std::span<const CodecRow> Codecs();
// Returns the codec; CODEC_RAW for CODEC_UNSPECIFIED and unknown values. The codec copies what it needs of `shape`.
// Thread-safe.
std::unique_ptr<Codec> MakeCodec(v1::Codec codec, const RestShape& shape);

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_CODECS_CODEC_H_
