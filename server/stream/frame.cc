#include "server/stream/frame.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "server/mechanics/measures/readings.h"
#include "server/mechanics/skinning/body_points.h"
#include "server/mechanics/skinning/displacements.h"
#include "server/mechanics/skinning/pose_matrices.h"
#include "server/mechanics/skinning/probe_position.h"
#include "server/stream/codecs/wire.h"
#include "server/stream/float_kernel.h"

namespace phrenic::stream {
namespace {

absl::Status NotFinite(const std::string& what, const State& state) {
  return absl::InternalError(absl::StrCat(what, " is not finite at tick ", state.tick, ": the frame is not sent"));
}

// Returns false if one is not finite.
bool AppendAsFloats(const ConstPoints& points, std::string& bytes) {
  constexpr Eigen::Index kTogether = 3072;  // stay in the L1 cache
  float floats[kTogether];
  bool finite = true;
  for (Eigen::Index first = 0; first < points.size(); first += kTogether) {
    const auto count = static_cast<std::size_t>(std::min(kTogether, points.size() - first));
    finite = ToFloats(points.data() + first, count, floats) && finite;
    bytes.append(reinterpret_cast<const char*>(floats), sizeof(float) * count);
  }
  return finite;
}

absl::Status AppendPositions(const Model& model, const Layout& layout, const State& state, const Scratch& scratch,
                             std::string& bytes) {
  bytes.reserve(sizeof(float) * 3 * layout.vertices());
  EvalContext at = MakeEvalContext(model, model.parameters, state, scratch);
  at.pose_matrices = PoseMatricesOf(at).data();
  at.displacements = DisplacementsOf(at, model.rest.data());
  for (int i = 0; i < static_cast<int>(model.bodies.size()); ++i) {
    if (layout.placement(i) != v1::PLACEMENT_STREAMED) continue;
    if (!AppendAsFloats(BodyPoints(model, i).Positions(at), bytes)) {
      return NotFinite(absl::StrCat("a vertex of ", model.bodies[i].name), state);
    }
  }
  return absl::OkStatus();
}

absl::Status AppendPoses(const State& state, std::string& bytes) {
  Eigen::MatrixXf floats(7, state.poses.size());
  for (int i = 0; i < static_cast<int>(state.poses.size()); ++i) {
    const Pose& pose = state.poses[i];
    floats.col(i) << pose.rotation.coeffs().cast<float>(), pose.translation.cast<float>();
  }
  if (!floats.allFinite()) return NotFinite("a pose", state);
  AppendFloats(floats, bytes);
  return absl::OkStatus();
}

absl::Status AddProbe(const Model& model, const State& state, const Probe& probe, const Scratch& scratch,
                      v1::Frame& frame) {
  const Eigen::Vector3d x = ProbePosition(model, state, probe, scratch);
  if (!x.allFinite()) return NotFinite(absl::StrCat("probe ", probe.name), state);
  const Eigen::Vector3d moved = x - model.bodies[probe.body].mesh.vertices.col(probe.vertex);
  v1::ProbeReading& reading = *frame.add_probes();
  reading.set_name(probe.name);
  reading.set_x(x.x());
  reading.set_y(x.y());
  reading.set_z(x.z());
  reading.set_dx(moved.x());
  reading.set_dy(moved.y());
  reading.set_dz(moved.z());
  return absl::OkStatus();
}

absl::Status AddScalars(const Model& model, const State& state, v1::Frame& frame) {
  for (int i = 0; i < static_cast<int>(model.scalars.size()); ++i) {
    const ScalarCoordinate& coordinate = model.scalars[i];
    const double value = state.scalars.q[i], rate = state.scalars.v[i];
    if (!std::isfinite(value) || !std::isfinite(rate)) {
      return NotFinite(absl::StrCat("coordinate ", coordinate.name), state);
    }
    if (coordinate.internal) continue;
    v1::ScalarReading& reading = *frame.add_scalars();
    reading.set_name(coordinate.name);
    reading.set_value(value);
    reading.set_rate(rate);
    reading.set_unit(coordinate.unit);
  }
  return absl::OkStatus();
}

}  // namespace

absl::Status AppendBodies(const Model& model, const Layout& layout, const State& state, std::string& positions,
                          std::string& poses, const Scratch& scratch) {
  absl::Status placed = AppendPositions(model, layout, state, scratch, positions);
  if (!placed.ok()) return placed;
  return AppendPoses(state, poses);
}

absl::StatusOr<v1::Frame> MakeFrame(const Model& model, const Layout& layout, const Snapshot& snapshot,
                                    const Scratch& scratch) {
  const State& state = snapshot.state;
  v1::Frame frame;
  frame.set_sequence(snapshot.sequence);
  frame.set_tick(state.tick);
  frame.set_time(state.time);
  frame.set_breath(MakeEvalContext(model, snapshot.parameters, state).breath);
  frame.set_phase(state.phase - std::floor(state.phase));
  frame.set_unix_nanos(absl::ToUnixNanos(snapshot.made));
  if (!std::isfinite(frame.time()) || !std::isfinite(frame.breath())) return NotFinite("the time", state);
  absl::Status placed = AppendBodies(model, layout, state, *frame.mutable_positions(), *frame.mutable_poses(), scratch);
  if (!placed.ok()) return placed;
  if (absl::Status status = AddScalars(model, state, frame); !status.ok()) return status;
  for (const Probe& probe : model.probes) {
    if (absl::Status status = AddProbe(model, state, probe, scratch, frame); !status.ok()) return status;
  }
  *frame.mutable_measures() = ReadMeasures(model, MakeEvalContext(model, snapshot.parameters, state, scratch));
  for (const v1::MeasureReading& reading : frame.measures()) {
    if (!std::isfinite(reading.value())) return NotFinite(absl::StrCat("measure ", reading.name()), state);
  }
  return frame;
}

}  // namespace phrenic::stream
