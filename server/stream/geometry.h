// The constant part of a session: meshes of bodies and their overlays.
#ifndef PHRENIC_SERVER_STREAM_GEOMETRY_H_
#define PHRENIC_SERVER_STREAM_GEOMETRY_H_

#include "phrenic/v1/frames.pb.h"
#include "server/mechanics/model.h"
#include "server/stream/layout.h"

namespace phrenic::stream {

// Returns the message of one body. Requires: 0 <= body < model.bodies.size().
v1::GetGeometryResponse MakeGeometry(const Model& model, const Layout& layout, int body);

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_GEOMETRY_H_
