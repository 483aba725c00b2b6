#include "server/mechanics/forces/gravity.h"

#include "absl/strings/str_cat.h"

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
  force->weight_ = Points::Zero(3, draft.model.rest.cols());
  std::int64_t count = 0;
  for (const int b : *bodies) {
    const BodyModel& body = draft.model.bodies[b];
    const auto vertices = body.mesh.vertices.cols();
    force->weight_.middleCols(body.first_vertex, vertices) =
        ToEigen(scene.acceleration()) * draft.model.mass.segment(body.first_vertex, vertices).transpose();
    count += vertices;
  }
  draft.ReportElement("force", name, count, "vertices", "f = m g");
  return force;
}

void Gravity::AddForce(const Instant&, MutablePoints f) const { f += weight_; }

double Gravity::Energy(const Instant& at) const { return -weight_.cwiseProduct(at.x).sum(); }

}  // namespace phrenic
