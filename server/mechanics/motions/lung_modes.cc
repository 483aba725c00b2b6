#include "server/mechanics/motions/lung_modes.h"

#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/mesh/topology.h"

namespace phrenic {

// A lung's tissue and its responses.
struct LungModes::Lung {
  int body;
  LungTissue tissue;
  double outwards;            // +1 left, -1 right
  std::vector<Points> nodes;  // displacement of its grid's nodes per parameter [1]; empty if it does not move the lung
};

namespace {

constexpr double kLeast = 0.25, kMost = 4;  // volume of a lung over that at rest

// Returns +1 for a left lung and -1 for a right one.
absl::StatusOr<double> OutwardsOf(const v1::Body& body, std::string_view path) {
  const bool lung = body.anatomy().structure() == v1::STRUCTURE_LUNG && body.anatomy().side() != v1::SIDE_UNSPECIFIED;
  if (lung) return body.anatomy().side() == v1::SIDE_LEFT ? 1.0 : -1.0;
  return FieldError(path, absl::StrCat("body \"", body.name(),
                                       "\" is no lung: set anatomy { structure: STRUCTURE_LUNG side: SIDE_RIGHT }"));
}

// The squared distance from the box, negative inside the surface.
double DistanceFrom(const LungTissue& tissue, const Eigen::Vector3d& point) {
  return tissue.Contains(point) ? -1 : tissue.box().squaredExteriorDistance(point);
}

// Returns the responses of a lung's nodes as columns, zero for those that do not move it.
Eigen::MatrixXd ShapesOf(const LungTissue& tissue, const std::vector<Points>& nodes) {
  Eigen::MatrixXd shapes = Eigen::MatrixXd::Zero(3 * tissue.grid().nodes().cols(), kModeParameters);
  for (size_t m = 0; m < nodes.size(); ++m) {
    if (nodes[m].cols() > 0) shapes.col(static_cast<Eigen::Index>(m)) = nodes[m].reshaped();
  }
  return shapes;
}

}  // namespace

const LungModes::Lung& LungModes::LungAt(const Eigen::Vector3d& point, int body, const std::vector<Lung>& lungs) {
  for (const Lung& lung : lungs) {
    if (lung.body == body) return lung;
  }
  const bool second = lungs.size() > 1 && DistanceFrom(lungs[1].tissue, point) < DistanceFrom(lungs[0].tissue, point);
  return lungs[second ? 1 : 0];
}

absl::StatusOr<std::vector<LungModes::Lung>> LungModes::Solve(const Names& names, std::string_view path,
                                                              const ModelBuilder& builder) {
  const auto bodies = builder.DeformableBodies(names, path);
  if (!bodies.ok()) return bodies.status();
  std::vector<Lung> lungs;
  for (const int body : *bodies) {
    const absl::StatusOr<double> outwards = OutwardsOf(builder.model.scene.bodies(body), path);
    if (!outwards.ok()) return outwards.status();
    const auto same_side = [&](const Lung& lung) { return lung.outwards == *outwards; };
    if (std::any_of(lungs.begin(), lungs.end(), same_side)) return FieldError(path, "two lungs are of one side");
    auto tissue = LungTissue::Make(builder.model.bodies[body].mesh, {}, builder.stop);
    if (!tissue.ok()) {
      return FieldError(path, absl::StrCat("body \"", builder.model.bodies[body].name,
                                           "\": ", std::string(tissue.status().message())));
    }
    Lung& lung = lungs.emplace_back(Lung{body, *std::move(tissue), *outwards, {}});
    for (const ModeParameter& parameter : ModeParameters()) {
      if (builder.stop.Stopped()) return builder.stop.status();
      lung.nodes.emplace_back(3, 0);
      if (!parameter.Moves(lung.outwards)) continue;
      const BoundaryMode& mode = BoundaryModes()[static_cast<size_t>(parameter.amplitude.mode)];
      lung.nodes.back() = ResponseTo(mode, lung.tissue, lung.outwards);
    }
  }
  return lungs;
}

void LungModes::Add(int body, const std::vector<Lung>& lungs, ModelBuilder& builder) {
  Model& model = builder.model;
  const BodyModel& added = model.bodies[body];
  const Eigen::Index n = added.mesh.vertices.cols();
  Moved& moved = moved_.emplace_back(
      Moved{added.first_vertex, added.mesh.vertices, Responses::Zero(3 * n, kModeParameters), {}, 0, added.name});
  const auto is_this = [body](const Lung& lung) { return lung.body == body; };
  if (std::any_of(lungs.begin(), lungs.end(), is_this)) {
    moved.faces = added.mesh.triangles;
    moved.rest_volume = SignedVolume(added.mesh.vertices, moved.faces);
  }
  for (Eigen::Index i = 0; i < n && !builder.stop.Stopped(); ++i) {
    const Eigen::Vector3d at = moved.rest.col(i);
    const Lung& lung = LungAt(at, body, lungs);
    for (Eigen::Index m = 0; m < kModeParameters; ++m) {
      const Points& nodes = lung.nodes[static_cast<size_t>(m)];
      if (nodes.cols() > 0) moved.responses.block<3, 1>(3 * i, m) = lung.tissue.DisplacementAt(nodes, at);
    }
    const int vertex = moved.first + static_cast<int>(i);
    if (model.inverse_mass[vertex] == 0) continue;
    model.inverse_mass[vertex] = 0;
    model.driven_vertices.push_back(vertex);
  }
}

absl::StatusOr<std::unique_ptr<Motion>> LungModes::Make(const v1::LungModes& scene, const std::string& given,
                                                        std::string_view path, ModelBuilder& builder) {
  const std::string field(path);
  const auto lungs = Solve(scene.lungs(), field + ".lungs", builder);
  if (!lungs.ok()) return lungs.status();
  std::unique_ptr<LungModes> motion(new LungModes(ElementName(given, "lung-modes", scene.lungs())));
  for (const Lung& lung : *lungs) {
    motion->insides_.push_back({lung.body, lung.tissue.grid(), lung.tissue.box(), ShapesOf(lung.tissue, lung.nodes)});
  }
  std::int64_t vertices = 0;
  const auto add = [&](const Names& names, const std::string& where) -> absl::Status {
    if (names.empty()) return absl::OkStatus();
    const auto bodies = builder.DeformableBodies(names, where);
    if (!bodies.ok()) return bodies.status();
    for (const int body : *bodies) {
      const std::vector<int>& driven = builder.model.driven_vertices;
      if (std::find(driven.begin(), driven.end(), builder.model.bodies[body].first_vertex) != driven.end()) {
        return FieldError(where, absl::StrCat("body \"", builder.model.bodies[body].name, "\" has a motion already"));
      }
      motion->Add(body, *lungs, builder);
      if (builder.stop.Stopped()) return builder.stop.status();
      vertices += motion->moved_.back().rest.cols();
    }
    return absl::OkStatus();
  };
  if (absl::Status status = add(scene.lungs(), field + ".lungs"); !status.ok()) return status;
  if (absl::Status status = add(scene.inside(), field + ".inside"); !status.ok()) return status;
  builder.ReportElement("motion", motion->name(), vertices, "vertices",
                        absl::StrCat(kModeParameters, " boundary modes"));
  return motion;
}

Eigen::Vector<double, kModeParameters> LungModes::AmplitudesAt(const EvalContext& at) {
  return at.parameters.breath_force() * at.breath * ModeAmplitudes(at.parameters);
}

const LungModes* LungModes::Find(const Model& model) {
  for (const auto& motion : model.motions) {
    if (const auto* modes = dynamic_cast<const LungModes*>(motion.get())) return modes;
  }
  return nullptr;
}

void LungModes::Drive(const EvalContext& at, State& state) const {
  const Eigen::Vector<double, kModeParameters> amplitudes = ModeAmplitudes(at.parameters);
  const double force = at.parameters.breath_force(), signal = force * at.breath, rate = force * at.breath_rate;
  for (const Moved& moved : moved_) {
    const Eigen::Index n = moved.rest.cols();
    Eigen::Map<Eigen::VectorXd> motion(state.v.col(moved.first).data(), 3 * n);
    motion.noalias() = moved.responses * amplitudes;
    state.x.middleCols(moved.first, n) = moved.rest + signal * state.v.middleCols(moved.first, n);
    motion *= rate;
  }
}

std::string LungModes::Warning(const State& state) const {
  for (const Moved& moved : moved_) {
    if (moved.faces.cols() == 0) continue;
    const double volume = SignedVolume(state.x.middleCols(moved.first, moved.rest.cols()), moved.faces);
    if (volume >= kLeast * moved.rest_volume && volume <= kMost * moved.rest_volume) continue;
    return absl::StrFormat(
        "%s has %.3g l, %.3g l at rest: no lung moves so far; lower breath_force or the amplitudes lung_*", moved.body,
        1e3 * volume, 1e3 * moved.rest_volume);
  }
  return "";
}

}  // namespace phrenic
