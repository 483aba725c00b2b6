#include "server/mesh/surface_walk.h"

#include <algorithm>

namespace phrenic {
namespace {

std::vector<std::vector<int>> TrianglesAtVertices(const Triangles& triangles) {
  std::vector<std::vector<int>> at(static_cast<size_t>(triangles.size() > 0 ? triangles.maxCoeff() + 1 : 0));
  for (int t = 0; t < static_cast<int>(triangles.cols()); ++t) {
    for (const int vertex : triangles.col(t)) at[vertex].push_back(t);
  }
  return at;
}

}  // namespace

SurfaceWalk::SurfaceWalk(const TriangleTree& tree) : tree_(tree) {
  const Triangles& triangles = tree.triangles();
  const auto at = TrianglesAtVertices(triangles);
  first_.reserve(static_cast<size_t>(triangles.cols()) + 1);
  first_.push_back(0);
  std::vector<int> around;
  for (int t = 0; t < static_cast<int>(triangles.cols()); ++t) {
    around.clear();
    for (const int vertex : triangles.col(t)) around.insert(around.end(), at[vertex].begin(), at[vertex].end());
    std::sort(around.begin(), around.end());
    around.erase(std::unique(around.begin(), around.end()), around.end());
    std::erase(around, t);
    neighbours_.insert(neighbours_.end(), around.begin(), around.end());
    first_.push_back(static_cast<int>(neighbours_.size()));
  }
}

SurfacePoint SurfaceWalk::Nearest(const ConstPoints& x, const Eigen::Vector3d& point, int from) const {
  SurfacePoint best;
  tree_.Try(x, point, from, best);
  for (int here = -1; here != best.triangle;) {
    here = best.triangle;
    const double before = best.squared;
    for (int i = first_[here]; i < first_[here + 1]; ++i) tree_.Try(x, point, neighbours_[i], best);
    if (!(best.squared < before)) break;  // only the triangle that counts as the nearest has changed
  }
  return best;
}

}  // namespace phrenic
