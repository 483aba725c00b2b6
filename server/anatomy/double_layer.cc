#include "server/anatomy/double_layer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace phrenic::anatomy {
namespace {

// Returns the gap at a vertex [mm]; it narrows towards the boundary within 8 mm.
double Gap(const Sheet& sheet, int vertex) {
  constexpr double kTaper = 8;
  double nearest = kTaper;
  for (const std::vector<int>& loop : sheet.loops) nearest = std::min(nearest, LoopDistance(sheet, loop, vertex));
  const double t = nearest / kTaper;
  return kBorderGap + (kDiaphragmGap - kBorderGap) * t * t * (3 - 2 * t);
}

}  // namespace

double LoopDistance(const Sheet& sheet, const std::vector<int>& loop, int vertex) {
  double square = std::numeric_limits<double>::infinity();
  for (const int other : loop) square = std::min(square, (sheet.points[other] - sheet.points[vertex]).squaredNorm());
  return std::sqrt(square);
}

Mesh DoubleLayer(const Sheet& sheet, const SheetNormal& normal) {
  Mesh mesh;
  const auto n = static_cast<int>(sheet.points.size());
  mesh.vertices.resize(3, 2 * n);
  for (int i = 0; i < n; ++i) {
    const Eigen::Vector3d half = Gap(sheet, i) / 2 * normal(sheet.plane[i]);
    mesh.vertices.col(UpperVertex(i)) = sheet.points[i] + half;
    mesh.vertices.col(LowerVertex(i)) = sheet.points[i] - half;
  }
  std::vector<Eigen::Vector3i> triangles;
  for (Eigen::Index t = 0; t < sheet.triangles.cols(); ++t) {
    const Eigen::Vector3i v = sheet.triangles.col(t);
    triangles.emplace_back(UpperVertex(v[0]), UpperVertex(v[1]), UpperVertex(v[2]));
  }
  for (Eigen::Index t = 0; t < sheet.triangles.cols(); ++t) {
    const Eigen::Vector3i v = sheet.triangles.col(t);
    triangles.emplace_back(LowerVertex(v[0]), LowerVertex(v[2]), LowerVertex(v[1]));
  }
  for (const auto& [a, b] : BoundaryEdges(sheet)) {
    triangles.emplace_back(UpperVertex(b), UpperVertex(a), LowerVertex(a));
    triangles.emplace_back(UpperVertex(b), LowerVertex(a), LowerVertex(b));
  }
  mesh.triangles.resize(3, static_cast<Eigen::Index>(triangles.size()));
  for (size_t t = 0; t < triangles.size(); ++t) mesh.triangles.col(static_cast<Eigen::Index>(t)) = triangles[t];
  return mesh;
}

}  // namespace phrenic::anatomy
