#include "server/mechanics/forces/friction.h"

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/mechanics/linalg/vertex_kernel.h"

namespace phrenic {

absl::StatusOr<std::unique_ptr<Force>> Friction::Make(const v1::Friction& scene, const std::string& given,
                                                      std::string_view path, ModelBuilder& builder) {
  const std::string name = ElementName(given, "friction", scene.bodies());
  auto bodies = builder.DeformableBodies(scene.bodies(), absl::StrCat(std::string(path), ".bodies"));
  if (!bodies.ok()) return bodies.status();
  if (scene.rate() == 0) {
    builder.ReportLeftOut(name, "its rate is 0");
    return nullptr;
  }
  std::unique_ptr<Friction> force(new Friction(name));
  force->coefficient_ = Eigen::VectorXd::Zero(builder.model.rest.cols());
  std::int64_t count = 0;
  for (const int b : *bodies) {
    const BodyModel& body = builder.model.bodies[b];
    const auto vertices = body.mesh.vertices.cols();
    force->coefficient_.segment(body.first_vertex, vertices) =
        scene.rate() * builder.model.mass.segment(body.first_vertex, vertices);
    count += vertices;
  }
  builder.ReportElement("force", name, count, "vertices", absl::StrFormat("rate %g 1/s", scene.rate()));
  return force;
}

void Friction::AddForceToBlock(const VertexRange& range, const BlockContext& at, MutablePoints f) const {
  VertexLoads loads;
  loads.c = coefficient_.data();
  AddLoads(range, loads, at.v, f);
}

}  // namespace phrenic
