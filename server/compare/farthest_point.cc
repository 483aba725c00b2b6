#include "server/compare/farthest_point.h"

#include <algorithm>
#include <cmath>
#include <queue>

namespace phrenic::compare {
namespace {

constexpr int kMostParts = 200'000;

// A triangle, or a part of one.
struct Piece {
  Eigen::Matrix3d corners;  // one a column
  double distance;          // of its middle [m]
  double upper;             // of every point's distance [m]
  bool operator<(const Piece& other) const { return upper < other.upper; }
};

class Search {
 public:
  Search(const MeasuredSurface& to, double found) : to_(to), found_(found) {}

  // Looks at a part of which no point is farther than `upper`, and whose middle is no farther than `reach`.
  void Look(const Eigen::Matrix3d& corners, double reach, double upper) {
    const Eigen::Vector3d middle = corners.rowwise().mean();
    const SurfacePoint nearest = to_.Nearest(middle, reach);
    const double distance = std::sqrt(nearest.squared);
    double by_triangle = 0;
    for (const auto corner : corners.colwise()) {
      by_triangle = std::max(by_triangle, to_.DistanceTo(nearest.triangle, corner));
    }
    const double by_middle = distance + (corners.colwise() - middle).colwise().norm().maxCoeff();
    found_ = std::max(found_, distance);
    ++looked_at_;
    const double least = std::min({by_triangle, by_middle, upper});
    if (least > Enough()) waiting_.push({corners, distance, least});
  }

  Farthest Run() {
    while (!waiting_.empty() && waiting_.top().upper > Enough() && looked_at_ < kMostParts) {
      const Piece part = waiting_.top();
      waiting_.pop();
      Halve(part);
    }
    return {found_, waiting_.empty() ? Enough() : std::max(Enough(), waiting_.top().upper)};
  }

  // What need not be looked at.
  double Enough() const { return found_ + std::max(1e-4 * found_, 1e-9); }

 private:
  void Halve(const Piece& part) {
    const Eigen::Vector3d a = part.corners.col(0), b = part.corners.col(1), c = part.corners.col(2);
    const Eigen::Vector3d ab = (a + b) / 2, bc = (b + c) / 2, ca = (c + a) / 2;
    const Eigen::Vector3d middle = part.corners.rowwise().mean();
    const auto look = [&](const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Eigen::Vector3d& r) {
      Eigen::Matrix3d corners;
      corners << p, q, r;
      Look(corners, part.distance + (corners.rowwise().mean() - middle).norm(), part.upper);
    };
    look(a, ab, ca);
    look(ab, b, bc);
    look(ca, bc, c);
    look(ab, bc, ca);
  }

  const MeasuredSurface& to_;
  double found_;
  int looked_at_ = 0;
  std::priority_queue<Piece> waiting_;
};

}  // namespace

Farthest FindFarthest(const MeasuredSurface& from, const MeasuredSurface& to, const Eigen::VectorXd& distances,
                      double found) {
  Search search(to, found);
  for (const auto triangle : from.triangles().colwise()) {
    Eigen::Matrix3d corners;
    corners << from.vertices().col(triangle[0]), from.vertices().col(triangle[1]), from.vertices().col(triangle[2]);
    const Eigen::Vector3d at(distances[triangle[0]], distances[triangle[1]], distances[triangle[2]]);
    const double longest = std::max({(corners.col(0) - corners.col(1)).norm(), (corners.col(1) - corners.col(2)).norm(),
                                     (corners.col(2) - corners.col(0)).norm()});
    const double upper = at.minCoeff() + longest;
    if (upper > search.Enough()) search.Look(corners, upper, upper);
  }
  return search.Run();
}

}  // namespace phrenic::compare
