#include "server/mechanics/compile/masses.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <span>
#include <vector>

#include "absl/strings/str_cat.h"
#include "server/mechanics/stiffness.h"
#include "server/mesh/normals.h"
#include "server/mesh/tetrahedra.h"

namespace phrenic {
namespace {

constexpr double kLeastShare = 0.5;  // smallest weight of a vertex, relative to the mean

// Returns each vertex's weight: a quarter of the volume of its tetrahedra [m^3], or of a surface a third of the area of
// its triangles [m^2].
Eigen::VectorXd Shares(const Mesh& mesh) {
  if (mesh.tetrahedra.cols() == 0) return VertexAreas(mesh.vertices, mesh.triangles);
  Eigen::VectorXd share = Eigen::VectorXd::Zero(mesh.vertices.cols());
  for (Eigen::Index t = 0; t < mesh.tetrahedra.cols(); ++t) {
    for (int k = 0; k < 4; ++k) share[mesh.tetrahedra(k, t)] += TetrahedronVolume(mesh, t) / 4;
  }
  return share;
}

// Distributes the total in proportion to the shares, each raised to at least kLeastShare of their mean. Requires: their
// sum is not 0.
Eigen::VectorXd Spread(double total, const Eigen::VectorXd& shares) {
  const double equal = shares.sum() / static_cast<double>(shares.size());
  const Eigen::VectorXd raised = shares.cwiseMax(kLeastShare * equal);
  return raised * (total / raised.sum());
}

// The diagonal blocks K_ii of the stiffness: that of each simulated vertex with all others fixed [N/m]. Ignores outer
// products (pressures that depend on a volume), whose diagonal blocks are small.
class OwnStiffness final : public StiffnessSink {
 public:
  explicit OwnStiffness(Eigen::Index vertices) : blocks_(vertices, Eigen::Matrix3d::Zero()) {}
  void Add(int i, int j, const Eigen::Matrix3d& block) override {
    if (i == j) blocks_[i] += block;
  }
  void AddSprings(std::span<const SpringStiffness> springs) override {
    for (const SpringStiffness& spring : springs) {
      const Eigen::Matrix3d block = spring.Block();
      blocks_[spring.a] += block;
      blocks_[spring.b] += block;
    }
  }
  void AddOuter(double, const Points&) override {}

  // Returns the largest eigenvalue of each block of the vertices [first, first + count) [N/m].
  Eigen::VectorXd Largest(Eigen::Index first, Eigen::Index count) const {
    Eigen::VectorXd largest(count);
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
    for (Eigen::Index i = 0; i < count; ++i) {
      solver.computeDirect(blocks_[first + i], Eigen::EigenvaluesOnly);
      largest[i] = std::max(0.0, solver.eigenvalues()[2]);
    }
    return largest;
  }

 private:
  std::vector<Eigen::Matrix3d> blocks_;
};

OwnStiffness StiffnessAtRest(const Model& model) {
  OwnStiffness stiffness(model.rest.cols());
  const State rest = model.InitialState();
  const EvalContext at = MakeEvalContext(model, model.parameters, rest);
  for (const auto& force : model.forces) {
    force->AddStiffness(at, stiffness);
    force->AddLatentStiffness(at, stiffness);
  }
  return stiffness;
}

bool ByStiffness(const v1::Body& body) {
  return body.mass_lumping() == v1::MASS_LUMPING_BY_STIFFNESS && body.role() == v1::ROLE_DEFORMABLE;
}

}  // namespace

absl::StatusOr<Eigen::VectorXd> VertexMasses(const v1::Body& body, const Mesh& mesh, std::string_view path) {
  const Eigen::Index n = mesh.vertices.cols();
  Eigen::VectorXd share = Shares(mesh);
  const double sum = share.sum();
  if (sum <= 0 && body.has_material()) {
    return FieldError(absl::StrCat(std::string(path), ".material"),
                      "the body has neither area nor volume: give it a mass instead");
  }
  const double thickness = mesh.tetrahedra.cols() == 0 ? body.material().thickness() : 1;
  const double total = body.has_material() ? body.material().density() * thickness * sum : body.mass();
  if (sum <= 0) return Eigen::VectorXd::Constant(n, total / static_cast<double>(n));
  return Spread(total, share);
}

absl::Status SpreadMassByStiffness(Model& model) {
  const auto& bodies = model.scene.bodies();
  if (std::none_of(bodies.begin(), bodies.end(), ByStiffness)) return absl::OkStatus();
  const OwnStiffness stiffness = StiffnessAtRest(model);
  for (int b = 0; b < bodies.size(); ++b) {
    if (!ByStiffness(bodies[b])) continue;
    const BodyModel& body = model.bodies[b];
    const auto vertices = body.mesh.vertices.cols();
    const Eigen::VectorXd shares = stiffness.Largest(body.first_vertex, vertices);
    if (shares.sum() == 0) {
      return FieldError(absl::StrCat("bodies[", b, "].mass_lumping"),
                        "nothing in the scene resists a motion of the body: leave MASS_LUMPING_BY_AREA");
    }
    auto mass = model.mass.segment(body.first_vertex, vertices);
    auto inverse = model.inverse_mass.segment(body.first_vertex, vertices);
    mass = Spread(mass.sum(), shares);
    inverse = (inverse.array() > 0).select(mass.cwiseInverse(), 0.0);
  }
  return absl::OkStatus();
}

}  // namespace phrenic
