#include "server/stream/state_arrays.h"

#include <set>

#include "absl/algorithm/container.h"
#include "server/stream/codecs/wire.h"
#include "server/stream/frame.h"

namespace phrenic::stream {
namespace {

constexpr std::size_t kPoseBytes = 7 * sizeof(float);  // a quaternion and a translation

void WriteLayout(const Model& model, v1::StateLayout& layout) {
  for (const BodyModel& body : model.bodies) {
    if (body.first_vertex < 0) continue;
    v1::SimulatedBody& row = *layout.add_bodies();
    row.set_name(body.name);
    row.set_first_vertex(body.first_vertex);
    row.set_vertices(body.mesh.vertices.cols());
  }
  for (const ScalarCoordinate& coordinate : model.scalars) {
    v1::StateScalar& row = *layout.add_scalars();
    row.set_name(coordinate.name);
    row.set_unit(coordinate.unit);
  }
}

absl::Status WritePart(const Model& model, const Layout& layout, const State& state, int part,
                       v1::StateArrays& arrays) {
  switch (static_cast<v1::StatePart>(part)) {
    case v1::STATE_PART_POSITIONS:
      arrays.set_positions(DoublesOf(state.x));
      break;
    case v1::STATE_PART_VELOCITIES:
      arrays.set_velocities(DoublesOf(state.v));
      break;
    case v1::STATE_PART_SCALARS:
      arrays.set_scalars(DoublesOf(state.scalars.q));
      arrays.set_scalar_rates(DoublesOf(state.scalars.v));
      break;
    case v1::STATE_PART_BODIES:
      return AppendBodies(model, layout, state, *arrays.mutable_body_positions(), *arrays.mutable_poses());
    case v1::STATE_PART_LAYOUT:
      WriteLayout(model, *arrays.mutable_layout());
      break;
    default:
      break;
  }
  return absl::OkStatus();
}

}  // namespace

absl::Status CheckParts(const StateParts& parts) {
  if (!absl::c_linear_search(parts, static_cast<int>(v1::STATE_PART_UNSPECIFIED))) return absl::OkStatus();
  return absl::InvalidArgumentError("read: STATE_PART_UNSPECIFIED is not a part of a state");
}

std::size_t StateBytes(const Model& model, const Layout& layout, const StateParts& parts) {
  const auto vertices = static_cast<std::size_t>(model.rest.cols());
  const std::set<int> wanted(parts.begin(), parts.end());
  const std::size_t points = wanted.count(v1::STATE_PART_POSITIONS) + wanted.count(v1::STATE_PART_VELOCITIES);
  std::size_t bytes = 3 * sizeof(double) * vertices * points;
  if (wanted.contains(v1::STATE_PART_SCALARS)) bytes += 2 * sizeof(double) * model.scalars.size();
  if (wanted.contains(v1::STATE_PART_BODIES)) {
    const auto driven = absl::c_count_if(model.bodies, [](const BodyModel& body) { return body.pose >= 0; });
    bytes += 3 * sizeof(float) * static_cast<std::size_t>(layout.vertices());
    bytes += kPoseBytes * static_cast<std::size_t>(driven);
  }
  return bytes;
}

absl::StatusOr<v1::StateArrays> MakeStateArrays(const Model& model, const Layout& layout, const State& state,
                                                const StateParts& parts) {
  v1::StateArrays arrays;
  arrays.set_tick(state.tick);
  arrays.set_time(state.time);
  arrays.set_phase(state.phase);
  for (const int part : std::set<int>(parts.begin(), parts.end())) {
    if (absl::Status status = WritePart(model, layout, state, part, arrays); !status.ok()) return status;
  }
  return arrays;
}

}  // namespace phrenic::stream
