#include "server/anatomy/diaphragm_mesh.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "server/anatomy/diaphragm_shape.h"
#include "server/anatomy/dimensions.h"
#include "server/anatomy/double_layer.h"
#include "server/anatomy/sheet_mesh.h"

namespace phrenic::anatomy {
namespace {

// A ball in which edges are at most `edge_length` long; outside, the limit grows by a third of the distance to it.
struct FineBall {
  Eigen::Vector3d centre;
  double radius, edge_length;
};

FineBall AroundOpening(const PlaneLoop& loop) {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const Eigen::Vector2d& p : loop) centre += DiaphragmPoint(p) / static_cast<double>(loop.size());
  double radius = 0;
  for (const Eigen::Vector2d& p : loop) radius = std::max(radius, (DiaphragmPoint(p) - centre).norm());
  return {centre, radius, radius / 2};
}

SheetDomain Domain(double edge_length) {
  SheetDomain domain;
  domain.map = DiaphragmPoint;
  domain.loops = {DiaphragmRim(), CavalOpening(), OesophagealOpening()};
  std::vector<FineBall> fine = {AroundOpening(domain.loops[1]), AroundOpening(domain.loops[2])};
  for (const double z : {30.0, 60.0, 90.0, 115.0}) {  // the crura
    fine.push_back({{0, SpineFront(z), z}, 28, 5});
  }
  domain.edge_length = [edge_length, fine](const Eigen::Vector3d& x) {
    double length = edge_length;
    for (const FineBall& ball : fine) {
      const double outside = std::max(0.0, (x - ball.centre).norm() - ball.radius);
      length = std::min(length, ball.edge_length + outside / 3);
    }
    return length;
  };
  return domain;
}

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
    } else if (!InTendon(p) && LoopDistance(sheet, sheet.loops[0], i) < band) {
      add("rim");
    }
  }
  for (auto& [name, region] : mesh.regions) std::sort(region.begin(), region.end());
}

}  // namespace

Mesh DiaphragmMesh(double edge_length) {
  const Sheet sheet = MeshSheet(Domain(edge_length));
  Mesh mesh = DoubleLayer(sheet, DiaphragmNormal);
  AddRegions(sheet, edge_length, mesh);
  return mesh;
}

}  // namespace phrenic::anatomy
