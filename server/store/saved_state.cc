#include "server/store/saved_state.h"

#include <bit>
#include <cstring>
#include <string>

#include "absl/strings/str_cat.h"

namespace phrenic::store {
namespace {

static_assert(std::endian::native == std::endian::little, "the store's numbers are little-endian");

constexpr int kPoseNumbers = 13;

std::string BytesOf(const Points& points) {
  return {reinterpret_cast<const char*>(points.data()), sizeof(double) * static_cast<size_t>(points.size())};
}

// Reads the coordinates of `vertices` vertices, 3 x n. DATA_LOSS names the field if there are more or fewer bytes.
absl::Status PointsOf(const char* field, const std::string& bytes, Eigen::Index vertices, Points& points) {
  if (bytes.size() != sizeof(double) * 3 * static_cast<size_t>(vertices)) {
    return absl::DataLossError(absl::StrCat(field, ": ", bytes.size(), " bytes do not hold ", vertices, " vertices"));
  }
  points.resize(3, vertices);
  std::memcpy(points.data(), bytes.data(), bytes.size());
  return absl::OkStatus();
}

void SavePose(const Pose& pose, v1::SavedPose& saved) {
  saved.mutable_values()->Reserve(kPoseNumbers);
  for (const double value : pose.rotation.coeffs()) saved.add_values(value);
  for (const auto* part : {&pose.translation, &pose.angular_velocity, &pose.velocity}) {
    for (const double value : *part) saved.add_values(value);
  }
}

Pose PoseOf(const v1::SavedPose& saved) {
  const double* values = saved.values().data();
  Pose pose;
  pose.rotation.coeffs() = Eigen::Map<const Eigen::Vector4d>(values);
  pose.translation = Eigen::Map<const Eigen::Vector3d>(values + 4);
  pose.angular_velocity = Eigen::Map<const Eigen::Vector3d>(values + 7);
  pose.velocity = Eigen::Map<const Eigen::Vector3d>(values + 10);
  return pose;
}

absl::Status RestoreHistory(const v1::SavedHistory& saved, Eigen::Index vertices, History& history) {
  history.integrator = saved.integrator();
  history.tick = saved.tick();
  history.dt = saved.dt();
  const std::tuple<const char*, const std::string&, Points&> parts[] = {
      {"history.positions", saved.positions(), history.x},
      {"history.velocities", saved.velocities(), history.v},
      {"history.forces", saved.forces(), history.force}};
  for (const auto& [field, bytes, points] : parts) {
    if (bytes.empty()) continue;
    if (absl::Status status = PointsOf(field, bytes, vertices, points); !status.ok()) return status;
  }
  return absl::OkStatus();
}

// A state that was saved before the model had scalars has none: they keep the model's initial values.
absl::Status RestoreScalars(const v1::SavedState& saved, ScalarState& scalars) {
  if (saved.scalars().empty() && saved.scalar_rates().empty()) return absl::OkStatus();
  const Eigen::Index count = scalars.q.size();
  if (saved.scalars_size() != count || saved.scalar_rates_size() != count) {
    return absl::DataLossError(absl::StrCat("scalars: ", saved.scalars_size(), " values and ",
                                            saved.scalar_rates_size(), " rates are not of ", count, " coordinates"));
  }
  scalars.q = Eigen::Map<const Eigen::VectorXd>(saved.scalars().data(), count);
  scalars.v = Eigen::Map<const Eigen::VectorXd>(saved.scalar_rates().data(), count);
  return absl::OkStatus();
}

}  // namespace

v1::SavedState Save(const State& state) {
  v1::SavedState saved;
  saved.set_time(state.time);
  saved.set_tick(state.tick);
  saved.set_phase(state.phase);
  saved.set_positions(BytesOf(state.x));
  saved.set_velocities(BytesOf(state.v));
  for (const Pose& pose : state.poses) SavePose(pose, *saved.add_poses());
  for (const VertexPull& pull : state.pulls) {
    v1::SavedPull& one = *saved.add_pulls();
    one.set_vertex(pull.vertex);
    for (const double value : pull.force) one.add_force(value);
  }
  v1::SavedHistory& history = *saved.mutable_history();
  history.set_integrator(state.history.integrator);
  history.set_tick(state.history.tick);
  history.set_dt(state.history.dt);
  history.set_positions(BytesOf(state.history.x));
  history.set_velocities(BytesOf(state.history.v));
  history.set_forces(BytesOf(state.history.force));
  saved.set_halvings(state.halvings);
  saved.mutable_scalars()->Assign(state.scalars.q.begin(), state.scalars.q.end());
  saved.mutable_scalar_rates()->Assign(state.scalars.v.begin(), state.scalars.v.end());
  return saved;
}

absl::StatusOr<State> ReadState(const v1::SavedState& saved) {
  const auto vertices = static_cast<Eigen::Index>(saved.positions().size() / (3 * sizeof(double)));
  State state;
  state.time = saved.time();
  state.tick = saved.tick();
  state.phase = saved.phase();
  state.halvings = saved.halvings();
  if (absl::Status status = PointsOf("positions", saved.positions(), vertices, state.x); !status.ok()) return status;
  if (absl::Status status = PointsOf("velocities", saved.velocities(), vertices, state.v); !status.ok()) return status;
  for (int i = 0; i < saved.poses_size(); ++i) {
    if (saved.poses(i).values_size() != kPoseNumbers) return absl::DataLossError(absl::StrCat("poses[", i, "]"));
    state.poses.push_back(PoseOf(saved.poses(i)));
  }
  for (const v1::SavedPull& pull : saved.pulls()) {
    const bool good = pull.vertex() >= 0 && pull.vertex() < vertices && pull.force_size() == 3;
    if (!good) return absl::DataLossError(absl::StrCat("pulls: vertex ", pull.vertex()));
    state.pulls.push_back({pull.vertex(), Eigen::Map<const Eigen::Vector3d>(pull.force().data())});
  }
  return state;
}

absl::StatusOr<State> Restore(const Model& model, const v1::SavedState& saved) {
  absl::StatusOr<State> state = ReadState(saved);
  if (!state.ok()) return state;
  const State first = model.InitialState();
  const Eigen::Index vertices = first.x.cols();
  if (state->x.cols() != vertices) {
    return absl::DataLossError(
        absl::StrCat("positions: ", saved.positions().size(), " bytes do not hold ", vertices, " vertices"));
  }
  if (state->poses.size() != first.poses.size()) return absl::DataLossError("poses: too few or many");
  state->scalars = first.scalars;
  if (absl::Status status = RestoreScalars(saved, state->scalars); !status.ok()) return status;
  if (absl::Status status = RestoreHistory(saved.history(), vertices, state->history); !status.ok()) return status;
  return state;
}

}  // namespace phrenic::store
