#include "server/mechanics/forces/springs.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/mesh/topology.h"

namespace phrenic {

absl::StatusOr<std::unique_ptr<Force>> Springs::Make(const v1::Springs& scene, const std::string& given,
                                                     std::string_view path, Draft& draft) {
  const std::string name = ElementName(given, "springs", scene.bodies());
  auto bodies = draft.DeformableBodies(scene.bodies(), absl::StrCat(std::string(path), ".bodies"));
  if (!bodies.ok()) return bodies.status();
  std::unique_ptr<Springs> force(new Springs(name));
  for (const int b : *bodies) {
    const BodyModel& body = draft.model.bodies[b];
    auto region = draft.Region(b, scene.region(), absl::StrCat(std::string(path), ".region"));
    if (!region.ok()) return region.status();
    const Edges edges = SpringEdges(body.mesh);
    for (Eigen::Index e = 0; e < edges.cols(); ++e) {
      const int a = edges(0, e), c = edges(1, e);
      if (!(*region)[a] || !(*region)[c]) continue;
      const double length = (body.mesh.vertices.col(a) - body.mesh.vertices.col(c)).norm();
      force->springs_.push_back(
          {body.first_vertex + a, body.first_vertex + c, scene.stiffness(), length * scene.rest_length_ratio()});
    }
  }
  if (force->springs_.empty()) {
    draft.ReportLeftOut(name, "no edge has both its vertices in the region");
    return nullptr;
  }
  if (scene.balanced_at_rest() && scene.rest_length_ratio() != 1) {
    force->rest_load_ = Points::Zero(3, draft.model.rest.cols());
    force->AddTension(-1, draft.model.rest, force->rest_load_);
  }
  const auto count = static_cast<std::int64_t>(force->springs_.size());
  draft.model.report.set_springs(draft.model.report.springs() + count);
  draft.ReportElement("force", name, count, "springs", absl::StrFormat("k = %g N/m", scene.stiffness()));
  return force;
}

void Springs::AddTension(double scale, const ConstPoints& x, MutablePoints f) const {
  const double* const position = x.data();
  double* const force = f.data();
  for (const Spring& spring : springs_) {
    const double* const a = position + 3 * static_cast<std::ptrdiff_t>(spring.a);
    const double* const b = position + 3 * static_cast<std::ptrdiff_t>(spring.b);
    const double dx = b[0] - a[0], dy = b[1] - a[1], dz = b[2] - a[2];
    const double length = std::sqrt(dx * dx + dy * dy + dz * dz);
    const double pull = length > 0 ? scale * spring.stiffness * (1 - spring.rest_length / length) : 0;
    double* const fa = force + 3 * static_cast<std::ptrdiff_t>(spring.a);
    double* const fb = force + 3 * static_cast<std::ptrdiff_t>(spring.b);
    fa[0] += pull * dx, fa[1] += pull * dy, fa[2] += pull * dz;
    fb[0] -= pull * dx, fb[1] -= pull * dy, fb[2] -= pull * dz;
  }
}

void Springs::AddForce(const Instant& at, MutablePoints f) const {
  AddTension(at.parameters.elasticity(), at.x, f);
  if (rest_load_.cols() > 0) f += at.parameters.elasticity() * rest_load_;
}

void Springs::AddStiffness(const Instant& at, StiffnessSink& sink) const {
  const double elasticity = at.parameters.elasticity();
  for (const Spring& spring : springs_) {
    const Eigen::Vector3d edge = at.x.col(spring.b) - at.x.col(spring.a);
    const double length = edge.norm();
    if (length == 0) continue;
    const Eigen::Matrix3d along = edge / length * (edge / length).transpose();
    const double transverse = std::max(0.0, 1 - spring.rest_length / length);
    sink.AddBetween(spring.a, spring.b,
                    elasticity * spring.stiffness * (along + transverse * (Eigen::Matrix3d::Identity() - along)));
  }
}

double Springs::Energy(const Instant& at) const {
  double energy = 0;
  for (const Spring& spring : springs_) {
    const double stretch = (at.x.col(spring.b) - at.x.col(spring.a)).norm() - spring.rest_length;
    energy += 0.5 * spring.stiffness * stretch * stretch;
  }
  if (rest_load_.cols() > 0) energy -= rest_load_.cwiseProduct(at.x).sum();
  return at.parameters.elasticity() * energy;
}

}  // namespace phrenic
