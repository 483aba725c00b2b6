#include "server/mechanics/forces/gravity.h"

#include "absl/strings/str_cat.h"
#include "server/mechanics/vertex_kernel.h"

namespace phrenic {

absl::StatusOr<std::unique_ptr<Force>> Gravity::Make(const v1::Gravity& scene, const std::string& given,
                                                     std::string_view path, Draft& draft) {
  const std::string name = ElementName(given, "gravity", scene.bodies());
  auto bodies = draft.DeformableBodies(scene.bodies(), absl::StrCat(std::string(path), ".bodies"));
  if (!bodies.ok()) return bodies.status();
  if (ToEigen(scene.acceleration()).isZero(0)) {
    draft.ReportLeftOut(name, "its acceleration is 0");
    return nullptr;
  }
  std::unique_ptr<Gravity> force(new Gravity(name));
  force->acceleration_ = ToEigen(scene.acceleration());
  force->mass_ = Eigen::VectorXd::Zero(draft.model.rest.cols());
  std::int64_t count = 0;
  for (const int b : *bodies) {
    const BodyModel& body = draft.model.bodies[b];
    const auto vertices = body.mesh.vertices.cols();
    force->mass_.segment(body.first_vertex, vertices) = draft.model.mass.segment(body.first_vertex, vertices);
    count += vertices;
  }
  draft.ReportElement("force", name, count, "vertices", "f = m g");
  return force;
}

void Gravity::AddForceIn(const VertexRange& range, const Instant&, MutablePoints f) const {
  AddShares(range, mass_, acceleration_, f);
}

double Gravity::Energy(const Instant& at) const { return -acceleration_.dot(at.x * mass_); }

}  // namespace phrenic
