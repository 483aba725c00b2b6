// The rest shape of streamed bodies, and their range among all streamed vertices.
#ifndef PHRENIC_SERVER_STREAM_REST_SHAPE_H_
#define PHRENIC_SERVER_STREAM_REST_SHAPE_H_

#include <vector>

#include "server/stream/codecs/codec.h"
#include "server/stream/layout.h"

namespace phrenic::stream {

// Returns all streamed bodies, ascending. Indices into model.bodies. Thread-safe, as all functions here.
std::vector<int> StreamedBodies(const Model& model, const Layout& layout);

// Returns the float32 rest positions and the mesh edges of these bodies, in their order. Rest positions are 3 x n [m].
// Edges are those of SpringEdges, with the vertices numbered from 0 over `bodies`. It has no basis shapes.
RestShape MakeRestShape(const Model& model, const std::vector<int>& bodies);

// Returns the columns of these bodies from `all`, the positions of all streamed bodies. Requires: the bodies are
// streamed, and `all` is 3 x layout.vertices() [m].
Floats Pick(const Model& model, const Layout& layout, const std::vector<int>& bodies, const Floats& all);

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_REST_SHAPE_H_
