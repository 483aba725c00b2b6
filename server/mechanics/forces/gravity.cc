#include "server/mechanics/forces/gravity.h"

#include <utility>

#include "absl/strings/str_cat.h"

namespace phrenic {

absl::StatusOr<std::unique_ptr<Force>> Gravity::Make(const v1::Gravity& scene, const std::string& given,
                                                     std::string_view path, ModelBuilder& builder) {
  const std::string name = ElementName(given, "gravity", scene.bodies());
  auto bodies = builder.DeformableBodies(scene.bodies(), absl::StrCat(std::string(path), ".bodies"));
  if (!bodies.ok()) return bodies.status();
  if (ToEigen(scene.acceleration()).isZero(0)) {
    builder.ReportLeftOut(name, "its acceleration is 0");
    return nullptr;
  }
  std::unique_ptr<Gravity> force(new Gravity(name));
  force->acceleration_ = ToEigen(scene.acceleration());
  Eigen::VectorXd mass = Eigen::VectorXd::Zero(builder.model.rest.cols());
  std::int64_t count = 0;
  for (const int b : *bodies) {
    const BodyModel& body = builder.model.bodies[b];
    const auto vertices = body.mesh.vertices.cols();
    mass.segment(body.first_vertex, vertices) = builder.model.mass.segment(body.first_vertex, vertices);
    count += vertices;
  }
  force->SetWeights(std::move(mass));
  builder.ReportElement("force", name, count, "vertices", "f = m g");
  return force;
}

}  // namespace phrenic
