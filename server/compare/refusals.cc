#include "server/compare/refusals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/mechanics/compile/compile.h"
#include "server/mechanics/lungs/lung_tissue.h"
#include "server/mesh/topology.h"
#include "server/mesh/units.h"
#include "server/schema/schema.h"

namespace phrenic::compare {
namespace {

// A use of the body "surface", and the scene that makes it.
struct Use {
  std::string what, scene;
};

constexpr char kAtRest[] = "bodies { name: 'surface' role: ROLE_AT_REST file { path: 'surface' } } ";
constexpr char kDeformable[] = "bodies { name: 'surface' role: ROLE_DEFORMABLE mass: 1 file { path: 'surface' } } ";
constexpr char kProbe[] = "bodies { name: 'probe' role: ROLE_DEFORMABLE mass: 1 polyhedron { vertices {} } } ";
constexpr char kSeen[] = "bodies { name: 'probe' role: ROLE_SEEN polyhedron { vertices {} } } ";

std::vector<Use> Uses() {
  return {
      {"a material (density) in place of a mass",
       "bodies { name: 'surface' role: ROLE_DEFORMABLE material {} file { path: 'surface' } } "},
      {"contact on it",
       absl::StrCat(kAtRest, kProbe, "forces { contact { bodies: 'probe' surfaces: 'surface' depth: 0.001 } }")},
      {"springs that draw to it",
       absl::StrCat(kAtRest, kProbe, "forces { target_spring { bodies: 'probe' surface: 'surface' } }")},
      {"a pressure on it",
       absl::StrCat(kDeformable, "forces { pressure { surface { bodies: 'surface' } pressure: 1 } }")},
      {"bodies that follow its triangles",
       absl::StrCat(kDeformable, kSeen,
                    "motions { skin { bodies: 'probe' drivers: 'surface' mode: SKIN_MODE_TRIANGLES } }")},
  };
}

// Returns the vertices in the order of their positions, so that coincident ones are neighbours.
std::vector<int> ByPosition(const Points& vertices) {
  std::vector<int> order(static_cast<std::size_t>(vertices.cols()));
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&vertices](int i) { return std::array{vertices(0, i), vertices(1, i), vertices(2, i)}; };
  std::sort(order.begin(), order.end(), [&](int a, int b) { return key(a) < key(b); });
  return order;
}

// Adds the use of rigid links between the first two vertices at one place, if there are two.
void AddLinks(const Mesh& surface, std::vector<Use>& uses) {
  const std::vector<int> order = ByPosition(surface.vertices);
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (surface.vertices.col(order[i - 1]) != surface.vertices.col(order[i])) continue;
    uses.push_back({"rigid links between coincident vertices",
                    absl::StrFormat("%sconstraints { rigid_links { body: 'surface' list { links { a: %d b: %d } } } }",
                                    kDeformable, order[i - 1], order[i])});
    return;
  }
}

// True if every component is closed, oriented and faces outwards.
bool FacesOutwards(const Mesh& surface) {
  if (surface.triangles.cols() == 0 || !AnalyseTopology(surface).watertight()) return false;
  const auto components = Components(surface);
  return std::all_of(components.begin(), components.end(), [&surface](const std::vector<int>& triangles) {
    return SignedVolume(surface.vertices, surface.triangles(Eigen::all, triangles)) > 0;
  });
}

void AddSolid(const Mesh& surface, std::vector<Use>& uses) {
  constexpr double kWork = 2e7, kCells = 8;  // triangles times cells; along the longest side
  const double longest = (surface.vertices.rowwise().maxCoeff() - surface.vertices.rowwise().minCoeff()).maxCoeff();
  if (FacesOutwards(surface) || !(longest > 0)) return;
  const double across = std::clamp(std::cbrt(kWork / static_cast<double>(surface.triangles.cols() + 1)), 2.0, kCells);
  const double cell = std::clamp(longest / across, 1e-6, 1e3);
  uses.push_back(
      {absl::StrFormat("a solid that fills it by cells of %g mm", cell * kMillimetresAMetre),
       absl::StrFormat("bodies { name: 'surface' role: ROLE_SEEN filling { cell: %.9g file { path: 'surface' } } }",
                       cell)});
}

// Compiles a scene. Returns the error, or OK.
absl::Status TryScene(const std::string& text, const Mesh& surface) {
  const absl::StatusOr<v1::Scene> scene = schema::ParseScene("scene", absl::StrCat("name: 'refusals' ", text));
  if (!scene.ok()) return scene.status();
  return Compile(*scene, [&surface](const v1::Body&) -> absl::StatusOr<Mesh> { return surface; }).status();
}

}  // namespace

std::vector<std::string> Refusals(const Mesh& surface) {
  if (const absl::Status any = TryScene(kAtRest, surface); !any.ok()) {
    return {absl::StrCat("any body: ", std::string(any.message()))};
  }
  std::vector<Use> uses = Uses();
  AddLinks(surface, uses);
  AddSolid(surface, uses);
  std::vector<std::string> refusals;
  for (const Use& use : uses) {
    const absl::Status status = TryScene(use.scene, surface);
    if (!status.ok()) refusals.push_back(absl::StrCat(use.what, ": ", std::string(status.message())));
  }
  if (const absl::Status lung = CheckLungSurface(surface); !lung.ok()) {
    refusals.push_back(absl::StrCat("a lung of elastic tissue: ", std::string(lung.message())));
  }
  return refusals;
}

}  // namespace phrenic::compare
