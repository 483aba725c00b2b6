#include "server/mesh/nearest.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nanoflann.hpp>
#include <utility>

namespace phrenic {
namespace {

constexpr int kLeafVertices = 32;  // a linear scan of so many is faster than descending further

// The point set in the form nanoflann asks for.
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

using KdTree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Cloud>, Cloud, 3, int>;

// Returns a slightly larger squared distance. The tree reports only points nearer than worstDist() and rounds its cell
// bounds; the margin keeps ties, which addPoint then compares exactly.
double WithMargin(double squared) { return squared * (1 + 1e-9) + std::numeric_limits<double>::min(); }

// nanoflann result set: the nearest vertex; ties go to the lowest index.
class NearestResult {
 public:
  explicit NearestResult(double reach) : squared_(WithMargin(reach * reach)), worst_(WithMargin(squared_)) {}
  bool addPoint(double squared, int vertex) {
    if (squared < squared_ || (squared == squared_ && vertex < vertex_)) {
      squared_ = squared;
      worst_ = WithMargin(squared);
      vertex_ = vertex;
    }
    return true;
  }
  double worstDist() const { return worst_; }
  bool full() const { return vertex_ >= 0; }
  Neighbour Within(double reach) const {
    const double distance = std::sqrt(squared_);
    if (full() && distance <= reach) return {vertex_, distance};
    return {-1, std::numeric_limits<double>::infinity()};
  }

 private:
  double squared_, worst_;
  int vertex_ = -1;
};

// nanoflann result set: every vertex within a squared distance.
class WithinResult {
 public:
  explicit WithinResult(double squared_limit) : limit_(squared_limit) {}
  bool addPoint(double squared, int vertex) {
    if (squared <= limit_) neighbours_.push_back({vertex, std::sqrt(squared)});
    return true;
  }
  double worstDist() const { return WithMargin(limit_); }
  bool full() const { return true; }
  std::vector<Neighbour> Take() { return std::move(neighbours_); }

 private:
  double limit_;
  std::vector<Neighbour> neighbours_;
};

}  // namespace

struct NearestSearch::Tree {
  explicit Tree(Points points)
      : cloud{std::move(points)}, index(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(kLeafVertices)) {}
  Cloud cloud;
  KdTree index;  // its constructor builds the tree over `cloud`
};

NearestSearch::NearestSearch(Points points) : tree_(std::make_unique<Tree>(std::move(points))) {}
NearestSearch::~NearestSearch() = default;

Neighbour NearestSearch::Nearest(const Eigen::Vector3d& point, double reach) const {
  NearestResult result(reach);
  tree_->index.findNeighbors(result, point.data(), nanoflann::SearchParams());
  return result.Within(reach);
}

std::vector<Neighbour> NearestSearch::Within(const Eigen::Vector3d& point, double radius) const {
  if (!(radius >= 0)) return {};
  WithinResult result(radius * radius);
  tree_->index.findNeighbors(result, point.data(), nanoflann::SearchParams());
  std::vector<Neighbour> neighbours = result.Take();
  std::sort(neighbours.begin(), neighbours.end(), [](const Neighbour& a, const Neighbour& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.vertex < b.vertex;
  });
  return neighbours;
}

}  // namespace phrenic
