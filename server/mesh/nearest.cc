#include "server/mesh/nearest.h"

#include <algorithm>
#include <cmath>
#include <nanoflann.hpp>

namespace phrenic {
namespace {

struct Cloud {
  Points points;
  size_t kdtree_get_point_count() const { return static_cast<size_t>(points.cols()); }
  double kdtree_get_pt(size_t i, size_t axis) const {
    return points(static_cast<Eigen::Index>(axis), static_cast<Eigen::Index>(i));
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

using KdTree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Cloud>, Cloud, 3, size_t>;

}  // namespace

struct NearestSearch::Tree {
  explicit Tree(Points points)
      : cloud{std::move(points)}, index(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(12)) {
    index.buildIndex();
  }
  Cloud cloud;
  KdTree index;
};

NearestSearch::NearestSearch(Points points) : tree_(std::make_unique<Tree>(std::move(points))) {}
NearestSearch::~NearestSearch() = default;

Neighbour NearestSearch::Nearest(const Eigen::Vector3d& point) const {
  constexpr size_t kTies = 4;  // equal distances among the first few are settled by the lower index
  size_t indices[kTies] = {};
  double squared[kTies] = {};
  const size_t found = tree_->index.knnSearch(point.data(), kTies, indices, squared);
  size_t best = 0;
  for (size_t i = 1; i < found; ++i) {
    if (squared[i] == squared[0] && indices[i] < indices[best]) best = i;
  }
  return {static_cast<int>(indices[best]), std::sqrt(squared[best])};
}

std::vector<Neighbour> NearestSearch::Within(const Eigen::Vector3d& point, double radius) const {
  std::vector<std::pair<size_t, double>> matches;
  tree_->index.radiusSearch(point.data(), radius * radius, matches, nanoflann::SearchParams());
  std::vector<Neighbour> neighbours;
  neighbours.reserve(matches.size());
  for (const auto& [index, squared] : matches) neighbours.push_back({static_cast<int>(index), std::sqrt(squared)});
  std::sort(neighbours.begin(), neighbours.end(), [](const Neighbour& a, const Neighbour& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.vertex < b.vertex;
  });
  return neighbours;
}

}  // namespace phrenic
