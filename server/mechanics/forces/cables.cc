#include "server/mechanics/forces/cables.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/mechanics/constraints/link.h"

namespace phrenic {

absl::StatusOr<std::unique_ptr<Force>> Cables::Make(const v1::Cables& scene, const std::string& given,
                                                    std::string_view path, ModelBuilder& builder) {
  const std::string name = given.empty() ? absl::StrCat("cables:", scene.body()) : given;
  auto body = DeformableBody(scene.body(), absl::StrCat(std::string(path), ".body"), builder);
  if (!body.ok()) return body.status();
  auto links = ListedOrEdges(scene.has_list(), scene.list(), scene.region(), *body, path, builder);
  if (!links.ok()) return links.status();
  if (links->empty()) {
    builder.ReportLeftOut(name, "no edge has both its vertices in the region");
    return nullptr;
  }
  std::unique_ptr<Cables> force(new Cables(name));
  force->stiffness_ = scene.stiffness();
  for (const Link& link : *links) force->cables_.push_back({link.a, link.b, link.length * scene.rest_length_ratio()});
  builder.ReportElement("force", name, static_cast<std::int64_t>(links->size()), "cables",
                        absl::StrFormat("k = %g N/m, tension only", scene.stiffness()));
  return force;
}

void Cables::AddForce(const EvalContext& at, MutablePoints f) const {
  const double stiffness = at.parameters.elasticity() * stiffness_;
  for (const Cable& cable : cables_) {
    const Eigen::Vector3d between = at.x.col(cable.b) - at.x.col(cable.a);
    const double length = between.norm();
    if (length <= cable.rest_length) continue;
    const Eigen::Vector3d pull = stiffness * (1 - cable.rest_length / length) * between;
    f.col(cable.a) += pull;
    f.col(cable.b) -= pull;
  }
}

void Cables::AddStiffness(const EvalContext& at, StiffnessSink& sink) const {
  const double stiffness = at.parameters.elasticity() * stiffness_;
  for (const Cable& cable : cables_) {
    const Eigen::Vector3d between = at.x.col(cable.b) - at.x.col(cable.a);
    const double length = between.norm();
    if (length <= cable.rest_length) continue;
    const double rest_fraction = cable.rest_length / length;
    const SpringStiffness spring{cable.a, cable.b, between, stiffness * rest_fraction / (length * length),
                                 stiffness * (1 - rest_fraction)};
    sink.AddSprings({&spring, 1});
  }
}

void Cables::AddLatentStiffness(const EvalContext& at, StiffnessSink& sink) const {
  const double stiffness = at.parameters.elasticity() * stiffness_;
  for (const Cable& cable : cables_) {
    const Eigen::Vector3d between = at.x.col(cable.b) - at.x.col(cable.a);
    if (between.norm() > cable.rest_length) continue;
    const SpringStiffness spring{cable.a, cable.b, between, 0, stiffness};
    sink.AddSprings({&spring, 1});
  }
}

double Cables::Energy(const EvalContext& at) const {
  double energy = 0;
  for (const Cable& cable : cables_) {
    const double stretch = std::max(0.0, (at.x.col(cable.b) - at.x.col(cable.a)).norm() - cable.rest_length);
    energy += 0.5 * stiffness_ * stretch * stretch;
  }
  return at.parameters.elasticity() * energy;
}

}  // namespace phrenic
