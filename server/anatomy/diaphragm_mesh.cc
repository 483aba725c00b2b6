#include "server/anatomy/diaphragm_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>
#include <vector>

#include "server/anatomy/diaphragm_shape.h"
#include "server/anatomy/dimensions.h"
#include "server/anatomy/sheet_mesh.h"

namespace phrenic::anatomy {
namespace {

// A ball in which edges are at most `edge_length` long; outside they grow by a third of the distance.
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

// The border's edges as the triangles run along them.
std::vector<std::pair<int, int>> BorderEdges(const Sheet& sheet) {
  std::set<std::pair<int, int>> along;
  for (Eigen::Index t = 0; t < sheet.triangles.cols(); ++t) {
    for (int k = 0; k < 3; ++k) along.emplace(sheet.triangles(k, t), sheet.triangles((k + 1) % 3, t));
  }
  std::vector<std::pair<int, int>> border;
  for (const auto& [a, b] : along) {
    if (!along.contains({b, a})) border.emplace_back(a, b);
  }
  return border;
}

double Distance(const Sheet& sheet, const std::vector<int>& loop, int vertex) {
  double square = std::numeric_limits<double>::infinity();
  for (const int other : loop) square = std::min(square, (sheet.points[other] - sheet.points[vertex]).squaredNorm());
  return std::sqrt(square);
}

// The gap narrows to the border within 8 mm.
double Gap(const Sheet& sheet, int vertex) {
  constexpr double kTaper = 8;
  double nearest = kTaper;
  for (const std::vector<int>& loop : sheet.loops) nearest = std::min(nearest, Distance(sheet, loop, vertex));
  const double t = nearest / kTaper;
  return kBorderGap + (kDiaphragmGap - kBorderGap) * t * t * (3 - 2 * t);
}

// The layers and the band that joins them along every loop.
void AddLayers(const Sheet& sheet, Mesh& mesh) {
  const auto n = static_cast<int>(sheet.points.size());
  mesh.vertices.resize(3, 2 * n);
  for (int i = 0; i < n; ++i) {
    const Eigen::Vector3d half = Gap(sheet, i) / 2 * DiaphragmNormal(sheet.plane[i]);
    mesh.vertices.col(i) = sheet.points[i] + half;
    mesh.vertices.col(n + i) = sheet.points[i] - half;
  }
  std::vector<Eigen::Vector3i> triangles;
  for (Eigen::Index t = 0; t < sheet.triangles.cols(); ++t) triangles.emplace_back(sheet.triangles.col(t));
  for (Eigen::Index t = 0; t < sheet.triangles.cols(); ++t) {
    const Eigen::Vector3i v = sheet.triangles.col(t);
    triangles.emplace_back(n + v[0], n + v[2], n + v[1]);
  }
  for (const auto& [a, b] : BorderEdges(sheet)) {
    triangles.emplace_back(b, a, n + a);
    triangles.emplace_back(b, n + a, n + b);
  }
  mesh.triangles.resize(3, static_cast<Eigen::Index>(triangles.size()));
  for (size_t t = 0; t < triangles.size(); ++t) mesh.triangles.col(static_cast<Eigen::Index>(t)) = triangles[t];
}

void AddRegions(const Sheet& sheet, double edge_length, Mesh& mesh) {
  const auto n = static_cast<int>(sheet.points.size());
  const double band = std::max(8.0, 1.2 * edge_length);
  for (int i = 0; i < n; ++i) {
    const auto add = [&](const char* name) {
      mesh.regions[name].push_back(i);
      mesh.regions[name].push_back(n + i);
    };
    const Eigen::Vector2d& p = sheet.plane[i];
    add(InTendon(p) ? "tendon" : "muscle");
    if (InRightCrus(p)) {
      add("crus-right");
    } else if (InLeftCrus(p)) {
      add("crus-left");
    } else if (!InTendon(p) && Distance(sheet, sheet.loops[0], i) < band) {
      add("rim");
    }
  }
  for (auto& [name, region] : mesh.regions) std::sort(region.begin(), region.end());
}

}  // namespace

Mesh DiaphragmMesh(double edge_length) {
  const Sheet sheet = MeshSheet(Domain(edge_length));
  Mesh mesh;
  AddLayers(sheet, mesh);
  AddRegions(sheet, edge_length, mesh);
  return mesh;
}

}  // namespace phrenic::anatomy
