#include "server/mechanics/forces/solid.h"

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/mechanics/forces/corotated.h"

namespace phrenic {

absl::StatusOr<std::unique_ptr<Force>> MakeSolid(const v1::Solid& scene, const std::string& given,
                                                 std::string_view path, ModelBuilder& builder) {
  const std::string name = ElementName(given, "solid", scene.bodies());
  const auto bodies = builder.DeformableBodies(scene.bodies(), absl::StrCat(std::string(path), ".bodies"));
  if (!bodies.ok()) return bodies.status();
  std::vector<FiniteElement<3>> elements;
  for (const int b : *bodies) {
    const BodyModel& body = builder.model.bodies[b];
    const auto selection = builder.Select(b, scene.region(), scene.exclude_region(), path);
    if (!selection.ok()) return selection.status();
    for (Eigen::Index t = 0; t < body.mesh.tetrahedra.cols(); ++t) {
      const Eigen::Vector4i corners = body.mesh.tetrahedra.col(t);
      if (!selection->Takes(corners)) continue;
      const Eigen::Vector4i vertices = corners.array() + body.first_vertex;
      FiniteElement<3> element = MakeTetrahedron(builder.model.rest, vertices);
      if (element.volume > 0) elements.push_back(std::move(element));
    }
  }
  if (elements.empty()) {
    builder.ReportLeftOut(name, "no tetrahedron with volume has all its vertices in the region");
    return nullptr;
  }
  builder.ReportElement("force", name, static_cast<std::int64_t>(elements.size()), "tetrahedra",
                        absl::StrFormat("E = %g Pa, nu = %g%s", scene.youngs_modulus(), scene.poissons_ratio(),
                                        scene.strain() == v1::STRAIN_LINEAR ? ", linear strain" : ""));
  return std::make_unique<Corotated<3>>(name, std::move(elements),
                                        OfSolid(scene.youngs_modulus(), scene.poissons_ratio()), scene.strain());
}

}  // namespace phrenic
