#include "server/physiology/lung_drive.h"

#include <cmath>

#include "server/mechanics/breathing/posture.h"
#include "server/mesh/topology.h"

namespace phrenic::physiology {
namespace {

// Returns the volume inside a closed surface times the middle of it [m^4].
Eigen::Vector3d FirstMoment(const Mesh& mesh) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3i corners : mesh.triangles.colwise()) {
    const Eigen::Matrix3d x = mesh.vertices(Eigen::all, corners);
    sum += x.determinant() / 24 * x.rowwise().sum();
  }
  return sum;
}

Mediastinum MakeMediastinum(const Mesh& sheet, const Mesh& wall, const std::vector<LungTissue>& tissues,
                            const std::vector<LungSurroundings>& surroundings) {
  Points boundary(3, 0);
  std::vector<bool> touches;
  for (size_t i = 0; i < tissues.size(); ++i) {
    const Eigen::Index before = boundary.cols();
    boundary.conservativeResize(3, before + tissues[i].points().cols());
    boundary.rightCols(tissues[i].points().cols()) = tissues[i].points();
    for (const LungNeighbour of : surroundings[i].neighbours()) touches.push_back(of == LungNeighbour::kMediastinum);
  }
  return {sheet, wall, boundary, touches};
}

}  // namespace

LungElasticity DrivenLungs() { return {.poisson = 0.42, .contact = 2000}; }

absl::StatusOr<std::vector<LungTissue>> MakeLungs(const Model& model, const Parts& parts,
                                                  const LungElasticity& elasticity, LungCauses causes,
                                                  const StopCheck& stop) {
  std::array<LungRoot, 2> roots = {{{-1, {}}, {1, {}}}};
  const auto root_of = [&](const BodyModel& body) -> LungRoot& {
    return roots[body.anatomy.side() == v1::SIDE_LEFT ? 1 : 0];
  };
  for (const int b : parts.lungs) {
    const BodyModel& body = model.bodies[static_cast<size_t>(b)];
    for (const auto& vertex : body.mesh.vertices.colwise()) root_of(body).box.extend(Eigen::Vector3d(vertex));
  }
  std::vector<LungTissue> tissues;
  for (const int b : parts.lungs) {
    const BodyModel& body = model.bodies[static_cast<size_t>(b)];
    LungElasticity rooted = elasticity;
    if (causes.root) rooted.root = root_of(body);
    absl::StatusOr<LungTissue> tissue = LungTissue::Make(body.mesh, rooted, stop);
    if (!tissue.ok()) return tissue.status();
    tissues.push_back(*std::move(tissue));
  }
  return tissues;
}

double FollowsSurroundings(v1::Side side, const v1::Parameters& parameters) {
  return 1 - (side == v1::SIDE_LEFT ? parameters.pneumothorax_left() : parameters.pneumothorax_right());
}

LungDrive::LungDrive(const Model& model, const Parts& parts, const std::vector<LungTissue>& tissues, LungCauses causes)
    : model_(model), parts_(parts), causes_(causes) {
  for (size_t i = 0; i < tissues.size(); ++i) {
    const BodyModel& body = model.bodies[static_cast<size_t>(parts.lungs[i])];
    surroundings_.emplace_back(model, parts.muscle, parts.wall, tissues[i], causes.margin);
    sides_.push_back(body.anatomy.side() == v1::SIDE_LEFT ? 1 : 0);
    beside_[sides_.back()] += surroundings_.back().BesideMediastinum();
    volume_ += SignedVolume(body.mesh.vertices, body.mesh.triangles);
    middle_ += FirstMoment(body.mesh);
  }
  middle_ /= volume_;
  mediastinum_ = MakeMediastinum(model.bodies[static_cast<size_t>(parts.muscle)].mesh,
                                 model.bodies[static_cast<size_t>(parts.wall)].mesh, tissues, surroundings_);
  for (const v1::Force& force : model.scene.forces()) {
    if (force.has_thorax_pressures()) pressures_ = force.thorax_pressures();
  }
}

std::array<double, 2> LungDrive::SpacesAt(const State& state, const v1::Parameters& parameters) const {
  if (!causes_.space) return {kNone, kNone};
  const EvalContext at = MakeEvalContext(model_, parameters, state);
  return {ReadOutput(parts_.pressures, "space_right", at), ReadOutput(parts_.pressures, "space_left", at)};
}

LungDrive::Moment LungDrive::At(const State& state, const v1::Parameters& parameters) const {
  const Points sheet = Placed(model_, state, parts_.muscle), wall = Placed(model_, state, parts_.wall);
  const std::array<double, 2> swept = causes_.space ? mediastinum_->Swept(sheet, wall) : std::array<double, 2>();
  const double follows[] = {FollowsSurroundings(v1::SIDE_RIGHT, parameters),
                            FollowsSurroundings(v1::SIDE_LEFT, parameters)};
  Moment moment;
  moment.space = SpacesAt(state, parameters);
  for (const size_t side : {0, 1}) moment.space[side] *= follows[side];
  for (size_t i = 0; i < surroundings_.size(); ++i) {
    const size_t side = sides_[i];
    const double narrowing = beside_[side] > 0 ? swept[side] / beside_[side] : 0;
    const MediastinalMotion mediastinum = mediastinum_->Stretched(sheet, narrowing);
    moment.displacement.push_back(follows[side] * surroundings_[i].Displacement(state, sheet, wall, mediastinum));
  }
  return moment;
}

LungWeight LungDrive::WeightIn(v1::Posture posture) const {
  if (!causes_.weight || !pressures_) return {};
  const v1::Vector& weight = pressures_->abdomen().weight();
  const Eigen::Vector3d supine(weight.x(), weight.y(), weight.z());
  return WeightOfLungs(pressures_->lungs(), volume_, middle_, DownIn(posture, supine).stableNormalized());
}

std::array<double, 2> FillingPressures(const std::array<double, 2>& space, const std::array<double, 2>& followed,
                                       const std::array<double, 2>& pressed) {
  std::array<double, 2> pressures = {};
  for (size_t side = 0; side < pressures.size(); ++side) {
    if (std::isnan(space[side]) || pressed[side] <= 0) continue;
    pressures[side] = (space[side] - followed[side]) / pressed[side];
  }
  return pressures;
}

}  // namespace phrenic::physiology
