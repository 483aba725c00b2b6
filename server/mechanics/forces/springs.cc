#include "server/mechanics/forces/springs.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/mesh/topology.h"

namespace phrenic {

namespace {

// Returns k/(E h) of each edge: the sum over its selected triangles of 3 area / (sum of squared edge lengths).
Eigen::VectorXd StiffnessFactors(const Mesh& mesh, const Edges& edges, const Selection& selection) {
  std::map<std::pair<int, int>, Eigen::Index> index;
  for (Eigen::Index e = 0; e < edges.cols(); ++e) index[std::minmax(edges(0, e), edges(1, e))] = e;
  Eigen::VectorXd factors = Eigen::VectorXd::Zero(edges.cols());
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    const Eigen::Vector3i corner = mesh.triangles.col(t);
    if (!selection.Takes(corner)) continue;
    const Eigen::Vector3d a = mesh.vertices.col(corner[0]);
    const Eigen::Vector3d b = mesh.vertices.col(corner[1]), c = mesh.vertices.col(corner[2]);
    const double squares = (b - a).squaredNorm() + (c - b).squaredNorm() + (a - c).squaredNorm();
    if (squares == 0) continue;
    for (int k = 0; k < 3; ++k) {
      const auto found = index.find(std::minmax(corner[k], corner[(k + 1) % 3]));
      if (found != index.end()) factors[found->second] += 1.5 * (b - a).cross(c - a).norm() / squares;
    }
  }
  return factors;
}

std::string Detail(const v1::Springs& scene) {
  const char* const precision = scene.precision() == v1::PRECISION_SINGLE ? ", single precision" : "";
  if (!scene.has_material()) return absl::StrFormat("k = %g N/m%s", scene.stiffness(), precision);
  return absl::StrFormat("k from E = %g Pa, thickness %g mm%s", scene.material().youngs_modulus(),
                         1e3 * scene.material().thickness(), precision);
}

void AppendSprings(const v1::Springs& scene, int b, const Selection& selection, const ModelBuilder& builder,
                   std::vector<Spring>& springs) {
  const BodyModel& body = builder.model.bodies[b];
  const bool others = scene.has_material() && body.mesh.edges.cols() > 0;
  const Edges of_triangles = others ? TriangleEdges(body.mesh.triangles) : Edges();
  const Edges& edges = others ? of_triangles : builder.EdgesOf(b);
  Eigen::VectorXd stiffness = Eigen::VectorXd::Constant(edges.cols(), scene.stiffness());
  if (scene.has_material()) {
    stiffness = scene.material().youngs_modulus() * scene.material().thickness() *
                StiffnessFactors(body.mesh, edges, selection);
  }
  for (Eigen::Index e = 0; e < edges.cols(); ++e) {
    const Eigen::Vector2i ends = edges.col(e);
    if (scene.has_material() ? stiffness[e] == 0 : !selection.Takes(ends)) continue;
    const double length = (body.mesh.vertices.col(ends[0]) - body.mesh.vertices.col(ends[1])).norm();
    springs.push_back(
        {body.first_vertex + ends[0], body.first_vertex + ends[1], stiffness[e], length * scene.rest_length_ratio()});
  }
}

absl::StatusOr<std::vector<Spring>> FindSprings(const v1::Springs& scene, std::string_view path,
                                                const ModelBuilder& builder) {
  auto bodies = builder.DeformableBodies(scene.bodies(), absl::StrCat(std::string(path), ".bodies"));
  if (!bodies.ok()) return bodies.status();
  std::vector<Spring> springs;
  for (const int b : *bodies) {
    const auto selection = builder.Select(b, scene.region(), scene.exclude_region(), path);
    if (!selection.ok()) return selection.status();
    AppendSprings(scene, b, *selection, builder, springs);
  }
  return springs;
}

// Adds `scale` times the forces of all springs to f [N].
void AddSpringForces(const std::vector<Spring>& springs, double scale, const ConstPoints& x, MutablePoints f) {
  for (const Spring& spring : springs) {
    const Eigen::Vector3d edge = x.col(spring.b) - x.col(spring.a);
    const double length = edge.norm();
    if (length == 0) continue;
    const Eigen::Vector3d pull = scale * spring.stiffness * (1 - spring.rest_length / length) * edge;
    f.col(spring.a) += pull;
    f.col(spring.b) -= pull;
  }
}

}  // namespace

absl::StatusOr<std::unique_ptr<Force>> Springs::Make(const v1::Springs& scene, const std::string& given,
                                                     std::string_view path, ModelBuilder& builder) {
  const std::string name = ElementName(given, "springs", scene.bodies());
  auto springs = FindSprings(scene, path, builder);
  if (!springs.ok()) return springs.status();
  if (springs->empty()) {
    builder.ReportLeftOut(name, "no edge has both its vertices in the region");
    return nullptr;
  }
  const auto count = static_cast<std::int64_t>(springs->size());
  const Points& rest = builder.model.rest;
  const Precision precision = scene.precision() == v1::PRECISION_SINGLE ? Precision::kSingle : Precision::kDouble;
  auto force = std::make_unique<Springs>(name, *std::move(springs), precision);
  if (scene.balanced_at_rest() && scene.rest_length_ratio() != 1) force->Balance(rest);
  builder.model.report.set_springs(builder.model.report.springs() + count);
  builder.ReportElement("force", name, count, "springs", Detail(scene));
  return force;
}

Springs::Springs(std::string name, std::vector<Spring> springs, Precision precision)
    : Force(std::move(name)), springs_(std::move(springs)), precision_(precision) {}

void Springs::Balance(const Points& rest) {
  rest_load_ = Points::Zero(3, rest.cols());
  AddSpringForces(springs_, -1, rest, rest_load_);
}

void Springs::AddForce(const EvalContext& at, MutablePoints f) const {
  AddSpringForces(springs_, at.parameters.elasticity(), at.x, f);
  if (balanced()) f += at.parameters.elasticity() * rest_load_;
}

void Springs::AddStiffness(const EvalContext& at, StiffnessSink& sink) const { sink.AddSpringsAt(springs_, at); }

double Springs::Energy(const EvalContext& at) const {
  double energy = 0;
  for (const Spring& spring : springs_) {
    const double stretch = (at.x.col(spring.b) - at.x.col(spring.a)).norm() - spring.rest_length;
    energy += 0.5 * spring.stiffness * stretch * stretch;
  }
  if (balanced()) energy -= rest_load_.cwiseProduct(at.x).sum();
  return at.parameters.elasticity() * energy;
}

}  // namespace phrenic
