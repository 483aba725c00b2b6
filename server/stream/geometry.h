// What never changes in a session: bodies as they look, and the overlays that lie on them.
#ifndef PHRENIC_SERVER_STREAM_GEOMETRY_H_
#define PHRENIC_SERVER_STREAM_GEOMETRY_H_

#include "phrenic/v1/frames.pb.h"
#include "server/mechanics/model.h"
#include "server/stream/layout.h"

namespace phrenic::stream {

// The message of one body, 0 <= body < model.bodies.size().
v1::GetGeometryResponse MakeGeometry(const Model& model, const Layout& layout, int body);

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_GEOMETRY_H_
