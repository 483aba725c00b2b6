#include "server/stream/frame.h"

#include <cmath>
#include <limits>

#include "absl/strings/str_cat.h"
#include "server/mechanics/measures/readings.h"
#include "server/mechanics/skinning/body_points.h"
#include "server/mechanics/skinning/displacements.h"
#include "server/mechanics/skinning/pose_matrices.h"
#include "server/mechanics/skinning/probe_position.h"
#include "server/stream/codecs/wire.h"
#include "server/stream/float_kernel.h"
#include "server/stream/rest_shape.h"

namespace phrenic::stream {
namespace {

absl::Status NotFinite(const std::string& what, const State& state) {
  return absl::InternalError(absl::StrCat(what, " is not finite at tick ", state.tick, ": the frame is not sent"));
}

// Frames have float32: a larger number becomes infinite.
bool IsFinite(const Points& x) {
  return (x.array().abs() <= static_cast<double>(std::numeric_limits<float>::max())).all();
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

absl::Status AppendPositions(const Model& model, const Layout& layout, const State& state, const Scratch& scratch,
                             std::string& bytes) {
  const std::size_t begin = bytes.size();
  bytes.resize(begin + sizeof(float) * 3 * static_cast<std::size_t>(layout.vertices()));
  return PlaceBodies(model, layout, state, StreamedBodies(model, layout),
                     reinterpret_cast<float*>(bytes.data() + begin), scratch);
}

}  // namespace

absl::Status PlaceBodies(const Model& model, const Layout& layout, const State& state, const std::vector<int>& bodies,
                         float* positions, const Scratch& scratch) {
  EvalContext at = MakeEvalContext(model, model.parameters, state, scratch);
  at.pose_matrices = PoseMatricesOf(at).data();
  at.displacements = DisplacementsOf(at, model.rest.data());
  for (const int body : bodies) {
    const ConstPoints x = BodyPoints(model, body).Positions(at);
    const std::ptrdiff_t first = 3 * std::ptrdiff_t{layout.first_vertex(body)};
    if (!ToFloats(x.data(), static_cast<std::size_t>(x.size()), positions + first)) {
      return NotFinite(absl::StrCat("a vertex of ", model.bodies[body].name), state);
    }
  }
  return absl::OkStatus();
}

absl::Status AppendBodies(const Model& model, const Layout& layout, const State& state, std::string& positions,
                          std::string& poses, const Scratch& scratch) {
  absl::Status placed = AppendPositions(model, layout, state, scratch, positions);
  if (!placed.ok()) return placed;
  return AppendPoses(state, poses);
}

absl::StatusOr<v1::Frame> MakeNumbers(const Model& model, const Snapshot& snapshot, const Scratch& scratch) {
  const State& state = snapshot.state;
  v1::Frame frame;
  frame.set_sequence(snapshot.sequence);
  frame.set_tick(state.tick);
  frame.set_time(state.time);
  frame.set_breath(MakeEvalContext(model, snapshot.parameters, state).breath);
  frame.set_phase(state.phase - std::floor(state.phase));
  frame.set_unix_nanos(absl::ToUnixNanos(snapshot.made));
  if (!std::isfinite(frame.time()) || !std::isfinite(frame.breath())) return NotFinite("the time", state);
  if (!IsFinite(state.x)) return NotFinite("a simulated vertex", state);
  if (absl::Status status = AppendPoses(state, *frame.mutable_poses()); !status.ok()) return status;
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

absl::StatusOr<v1::Frame> MakeFrame(const Model& model, const Layout& layout, const Snapshot& snapshot,
                                    const Scratch& scratch) {
  absl::StatusOr<v1::Frame> frame = MakeNumbers(model, snapshot, scratch);
  if (!frame.ok()) return frame;
  absl::Status placed = AppendPositions(model, layout, snapshot.state, scratch, *frame->mutable_positions());
  if (!placed.ok()) return placed;
  return frame;
}

}  // namespace phrenic::stream
