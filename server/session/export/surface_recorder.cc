#include "server/session/export/surface_recorder.h"

#include "server/mesh/units.h"
#include "server/meshio/formats.h"

namespace phrenic::session {
namespace {

// Joins all bodies into one surface.
Mesh Joined(const std::vector<record::RecordedBody>& bodies, const Points& positions) {
  Mesh joined;
  joined.vertices = positions;
  int first = 0;
  for (const record::RecordedBody& body : bodies) {
    const auto append = [first](auto& all, const auto& some) {
      const Eigen::Index before = all.cols();
      all.conservativeResize(Eigen::NoChange, before + some.cols());
      all.rightCols(some.cols()) = some.array() + first;
    };
    append(joined.triangles, body.mesh.triangles);
    append(joined.edges, body.mesh.edges);
    first += static_cast<int>(body.mesh.vertices.cols());
  }
  if (joined.triangles.cols() > 0) joined.edges.resize(2, 0);
  return joined;
}

}  // namespace

absl::Status SurfaceRecorder::Begin(const record::Recording& recording) {
  bodies_ = recording.bodies;
  return absl::OkStatus();
}

absl::Status SurfaceRecorder::AddFrame(const record::RecordedFrame& frame) {
  positions_ = frame.positions;
  return absl::OkStatus();
}

absl::Status SurfaceRecorder::End(const std::function<absl::Status(double share)>& /*report*/) {
  const auto bytes = meshio::Write("surface" + ending_, Joined(bodies_, positions_), kMillimetre);
  return bytes.ok() ? sink_(*bytes) : bytes.status();
}

}  // namespace phrenic::session
