// The constant part of a session: meshes of bodies and their overlays.
#ifndef PHRENIC_SERVER_STREAM_GEOMETRY_H_
#define PHRENIC_SERVER_STREAM_GEOMETRY_H_

#include "phrenic/v1/frames.pb.h"
#include "server/mechanics/model.h"
#include "server/stream/layout.h"

namespace phrenic::stream {

// Returns the message of one body. Requires: 0 <= body < model.bodies.size(). Rest positions are little-endian float32
// [m], indices uint32, from 0 within the body (proto/README.md). The look comes from the scene's layer; without one,
// opaque grey. Constant for a session, so that clients ask once. Thread-safe.
v1::GetGeometryResponse MakeGeometry(const Model& model, const Layout& layout, int body);

}  // namespace phrenic::stream

#endif  // PHRENIC_SERVER_STREAM_GEOMETRY_H_
