// How the positions of vertices become bytes and come back: one codec a file in codecs/, one row a codec in codecs.cc.
#ifndef PHRENIC_SERVER_STREAM_CODEC_H_
#define PHRENIC_SERVER_STREAM_CODEC_H_

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "phrenic/v1/frames.pb.h"
#include "server/mesh/mesh.h"

namespace phrenic::stream {

using Floats = Eigen::Matrix3Xf;  // 3 x n [m], one column per vertex

// What both ends know of the vertices that travel, from the geometry.
struct RestShape {
  Floats rest;
  Edges edges;                      // which vertices are beside each other
  std::vector<Floats> shapes = {};  // displacements of all vertices, of which codecs may put frames together
};

// Every encoding stands by itself: given the rest shape, no other frame is needed. Immutable; any thread may call.
class Codec {
 public:
  virtual ~Codec() = default;
  // `positions` are finite and as many as at rest. No decoded vertex lies further than `max_error` [m] from its own.
  // OUT_OF_RANGE where the codec cannot keep that: they lie too far apart, or the bound is finer than float32.
  virtual absl::StatusOr<std::string> Encode(const Floats& positions, double max_error) const = 0;
  // INVALID_ARGUMENT for bytes that are no encoding of so many vertices; whatever the bytes, what comes out is finite.
  virtual absl::StatusOr<Floats> Decode(std::string_view bytes) const = 0;
};

struct CodecRow {
  v1::Codec codec;
  std::string_view name;
  std::unique_ptr<Codec> (*make)(const RestShape& shape);
};

// One row a codec, CODEC_RAW first.
std::span<const CodecRow> Codecs();
// The codec of that row; CODEC_UNSPECIFIED and what has no row is CODEC_RAW.
std::unique_ptr<Codec> MakeCodec(v1::Codec codec, const RestShape& shape);

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_CODEC_H_
