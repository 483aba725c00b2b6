// The rest shape of the bodies that travel, and where they are among all streamed vertices.
#ifndef PHRENIC_SERVER_STREAM_REST_SHAPE_H_
#define PHRENIC_SERVER_STREAM_REST_SHAPE_H_

#include <vector>

#include "server/stream/codec.h"
#include "server/stream/layout.h"

namespace phrenic::stream {

// All streamed bodies, ascending.
std::vector<int> StreamedBodies(const Model& model, const Layout& layout);

// Of these streamed bodies, one after the other: float32 rest positions, and the edges that springs would lie on.
RestShape MakeRestShape(const Model& model, const std::vector<int>& bodies);

// Their columns of the positions of all streamed bodies.
Floats Pick(const Model& model, const Layout& layout, const std::vector<int>& bodies, const Floats& all);

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_REST_SHAPE_H_
