#include "server/anatomy/diaphragm_mesh.h"

#include <algorithm>

#include "server/anatomy/diaphragm_shape.h"
#include "server/anatomy/diaphragm_sheet.h"
#include "server/anatomy/double_layer.h"

namespace phrenic::anatomy {
namespace {

void AddRegions(const Sheet& sheet, double edge_length, Mesh& mesh) {
  const auto n = static_cast<int>(sheet.points.size());
  const double band = std::max(8.0, 1.2 * edge_length);
  for (int i = 0; i < n; ++i) {
    const auto add = [&](const char* name) {
      mesh.regions[name].push_back(UpperVertex(i));
      mesh.regions[name].push_back(LowerVertex(i));
    };
    const Eigen::Vector2d& p = sheet.plane[i];
    add(InTendon(p) ? "tendon" : "muscle");
    if (InRightCrus(p)) {
      add("crus-right");
    } else if (InLeftCrus(p)) {
      add("crus-left");
    } else if (!InTendon(p) && LoopDistance(sheet, sheet.loops[kRimLoop], i) < band) {
      add("rim");
    }
  }
  for (auto& [name, region] : mesh.regions) std::sort(region.begin(), region.end());
}

}  // namespace

Mesh DiaphragmMesh(double edge_length) {
  const Sheet sheet = DiaphragmSheet(edge_length);
  Mesh mesh = DoubleLayer(sheet, DiaphragmNormal);
  AddRegions(sheet, edge_length, mesh);
  return mesh;
}

}  // namespace phrenic::anatomy
