#include "server/mechanics/masses.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "server/mechanics/forces/springs.h"
#include "server/mesh/normals.h"
#include "server/mesh/tetrahedra.h"

namespace phrenic {
namespace {

constexpr double kLeastShare = 0.5;  // of an equal one

// A quarter of the volume of the tetrahedra around each vertex [m^3]; a third of the area of the triangles [m^2] of a
// surface.
Eigen::VectorXd Shares(const Mesh& mesh) {
  if (mesh.tetrahedra.cols() == 0) return VertexAreas(mesh.vertices, mesh.triangles);
  Eigen::VectorXd share = Eigen::VectorXd::Zero(mesh.vertices.cols());
  for (Eigen::Index t = 0; t < mesh.tetrahedra.cols(); ++t) {
    for (int k = 0; k < 4; ++k) share[mesh.tetrahedra(k, t)] += TetrahedronVolume(mesh, t) / 4;
  }
  return share;
}

// The total spread by shares whose sum is not 0.
Eigen::VectorXd Spread(double total, const Eigen::VectorXd& shares) {
  const double equal = shares.sum() / static_cast<double>(shares.size());
  const Eigen::VectorXd raised = shares.cwiseMax(kLeastShare * equal);
  return raised * (total / raised.sum());
}

// The sum of the stiffness of each simulated vertex's springs [N/m].
absl::StatusOr<Eigen::VectorXd> StiffnessOfSprings(const Draft& draft) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(draft.model.rest.cols());
  for (int i = 0; i < draft.model.scene.forces_size(); ++i) {
    const v1::Force& force = draft.model.scene.forces(i);
    if (!force.has_springs()) continue;
    const auto springs = Springs::Find(force.springs(), absl::StrCat("forces[", i, "].springs"), draft);
    if (!springs.ok()) return springs.status();
    for (const Spring& spring : *springs) {
      sum[spring.a] += spring.stiffness;
      sum[spring.b] += spring.stiffness;
    }
  }
  return sum;
}

bool ByStiffness(const v1::Body& body) {
  return body.mass_shares() == v1::MASS_SHARES_BY_STIFFNESS && body.role() == v1::ROLE_DEFORMABLE;
}

}  // namespace

absl::StatusOr<Eigen::VectorXd> VertexMasses(const v1::Body& body, const Mesh& mesh, std::string_view path) {
  const Eigen::Index n = mesh.vertices.cols();
  Eigen::VectorXd share = Shares(mesh);
  const double sum = share.sum();
  if (sum <= 0 && body.has_substance()) {
    return FieldError(absl::StrCat(std::string(path), ".substance"),
                      "the body has neither area nor volume: give it a mass instead");
  }
  const double thickness = mesh.tetrahedra.cols() == 0 ? body.substance().thickness() : 1;
  const double total = body.has_substance() ? body.substance().density() * thickness * sum : body.mass();
  if (sum <= 0) return Eigen::VectorXd::Constant(n, total / static_cast<double>(n));
  return Spread(total, share);
}

absl::Status SpreadMassByStiffness(Draft& draft) {
  Model& model = draft.model;
  const auto& bodies = model.scene.bodies();
  if (std::none_of(bodies.begin(), bodies.end(), ByStiffness)) return absl::OkStatus();
  const auto stiffness = StiffnessOfSprings(draft);
  if (!stiffness.ok()) return stiffness.status();
  for (int b = 0; b < bodies.size(); ++b) {
    if (!ByStiffness(bodies[b])) continue;
    const BodyModel& body = model.bodies[b];
    const auto vertices = body.mesh.vertices.cols();
    const Eigen::VectorXd shares = stiffness->segment(body.first_vertex, vertices);
    if (shares.sum() == 0) {
      return FieldError(absl::StrCat("bodies[", b, "].mass_shares"),
                        "no spring of the scene acts on the body: leave MASS_SHARES_BY_AREA");
    }
    auto mass = model.mass.segment(body.first_vertex, vertices);
    auto inverse = model.inverse_mass.segment(body.first_vertex, vertices);
    mass = Spread(mass.sum(), shares);
    inverse = (inverse.array() > 0).select(mass.cwiseInverse(), 0.0);
  }
  return absl::OkStatus();
}

}  // namespace phrenic
