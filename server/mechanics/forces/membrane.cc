#include "server/mechanics/forces/membrane.h"

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/mechanics/forces/corotated.h"

namespace phrenic {

absl::StatusOr<std::unique_ptr<Force>> MakeMembrane(const v1::Membrane& scene, const std::string& given,
                                                    std::string_view path, ModelBuilder& builder) {
  const std::string name = ElementName(given, "membrane", scene.bodies());
  const auto bodies = builder.DeformableBodies(scene.bodies(), absl::StrCat(std::string(path), ".bodies"));
  if (!bodies.ok()) return bodies.status();
  std::vector<FiniteElement<2>> elements;
  for (const int b : *bodies) {
    const BodyModel& body = builder.model.bodies[b];
    const auto selection = builder.Select(b, scene.region(), scene.exclude_region(), path);
    if (!selection.ok()) return selection.status();
    for (Eigen::Index t = 0; t < body.mesh.triangles.cols(); ++t) {
      const Eigen::Vector3i corners = body.mesh.triangles.col(t);
      if (!selection->Takes(corners)) continue;
      const Eigen::Vector3i vertices = corners.array() + body.first_vertex;
      FiniteElement<2> element = MakeTriangle(builder.model.rest, vertices, scene.thickness());
      if (element.volume > 0) elements.push_back(std::move(element));
    }
  }
  if (elements.empty()) {
    builder.ReportLeftOut(name, "no triangle with area has all its vertices in the region");
    return nullptr;
  }
  builder.ReportElement(
      "force", name, static_cast<std::int64_t>(elements.size()), "triangles",
      absl::StrFormat("E = %g Pa, nu = %g, %g mm thick%s", scene.youngs_modulus(), scene.poissons_ratio(),
                      1e3 * scene.thickness(), scene.strain() == v1::STRAIN_LINEAR ? ", linear strain" : ""));
  return std::make_unique<Corotated<2>>(name, std::move(elements),
                                        PlaneStress(scene.youngs_modulus(), scene.poissons_ratio()), scene.strain());
}

}  // namespace phrenic
