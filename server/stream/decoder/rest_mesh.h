// The rest shape of streamed vertices as plain arrays, so that the decoder compiles without any library.
#ifndef PHRENIC_SERVER_STREAM_DECODER_REST_MESH_H_
#define PHRENIC_SERVER_STREAM_DECODER_REST_MESH_H_

#include <cstddef>
#include <span>

namespace phrenic::stream {

// Requires: the length of `rest` is a multiple of 3, that of `edges` of 2, and all indices in `edges` are vertices.
struct RestMesh {
  std::span<const float> rest;  // x y z per vertex [m]
  std::span<const int> edges;   // pairs of neighbouring vertices; may repeat pairs

  std::size_t vertices() const { return rest.size() / 3; }
};

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_DECODER_REST_MESH_H_
