#include "server/phantom/structures.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "absl/strings/str_cat.h"
#include "server/fluoroscopy/absorbers.h"
#include "server/fluoroscopy/closing.h"

namespace phrenic::phantom {
namespace {

// Returns the name that TotalSegmentator gives a rib or a vertebra, else the body's with "_" in place of "-".
std::string LabelName(const BodyModel& body) {
  const v1::Anatomy& anatomy = body.anatomy;
  const int number = anatomy.number();
  if (anatomy.structure() == v1::STRUCTURE_RIB && number > 0) {
    return absl::StrCat("rib_", anatomy.side() == v1::SIDE_LEFT ? "left" : "right", "_", number);
  }
  if (anatomy.structure() == v1::STRUCTURE_VERTEBRA && number > 0) {
    constexpr int kThoracic = 12;
    return number > kThoracic ? absl::StrCat("vertebrae_L", number - kThoracic) : absl::StrCat("vertebrae_T", number);
  }
  std::string name = body.name;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

std::string ColorOf(const v1::Scene& scene, const std::string& layer) {
  const auto found = std::find_if(scene.layers().begin(), scene.layers().end(),
                                  [&](const v1::Layer& each) { return each.name() == layer; });
  return found == scene.layers().end() ? "" : found->color();
}

}  // namespace

absl::StatusOr<Structures> FindStructures(const Model& model) {
  Structures found;
  const std::vector<std::optional<fluoroscopy::Tissue>> tissues = fluoroscopy::TissuesOf(model);
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    const BodyModel& body = model.bodies[b];
    const std::optional<fluoroscopy::Tissue> tissue = tissues[static_cast<std::size_t>(b)];
    if (!tissue) continue;
    const std::optional<Triangles> closed = fluoroscopy::ClosedTriangles(body.mesh.vertices, body.mesh.triangles);
    if (!closed) {
      found.open.push_back(body.name);
      continue;
    }
    if (found.all.size() == std::numeric_limits<imaging::Label>::max()) {
      return absl::FailedPreconditionError("the scene has more bodies than a label volume has labels, 65535");
    }
    found.all.push_back({b, static_cast<imaging::Label>(found.all.size() + 1), LabelName(body), body.anatomy, *tissue,
                         ColorOf(model.scene, body.layer), *closed});
  }
  if (!found.all.empty()) return found;
  return absl::FailedPreconditionError(
      "no closed body of the scene has a tissue: names or layers such as rib, t8, lung or heart tell it");
}

}  // namespace phrenic::phantom
