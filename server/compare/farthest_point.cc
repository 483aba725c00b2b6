#include "server/compare/farthest_point.h"

#include <algorithm>
#include <cmath>
#include <queue>

namespace phrenic::compare {
namespace {

constexpr int kMaxPieces = 200'000;

// A triangle or a piece of one.
struct Piece {
  Eigen::Matrix3d corners;  // one per column [m]
  double distance;          // of its centroid [m]
  double upper;             // upper bound of the distance of its points [m]
  bool operator<(const Piece& other) const { return upper < other.upper; }
};

class Search {
 public:
  Search(const MeasuredSurface& to, double found) : to_(to), found_(found) {}

  // Evaluates a piece; queues it if it may hold the farthest point. `upper` bounds the distance of all its points,
  // `reach` that of its centroid.
  void Evaluate(const Eigen::Matrix3d& corners, double reach, double upper) {
    const Eigen::Vector3d middle = corners.rowwise().mean();
    const SurfacePoint nearest = to_.Nearest(middle, reach);
    const double distance = std::sqrt(nearest.squared);
    double by_triangle = 0;
    for (const auto corner : corners.colwise()) {
      by_triangle = std::max(by_triangle, to_.DistanceTo(nearest.triangle, corner));
    }
    const double by_middle = distance + (corners.colwise() - middle).colwise().norm().maxCoeff();
    found_ = std::max(found_, distance);
    ++evaluated_;
    const double least = std::min({by_triangle, by_middle, upper});
    if (least > Enough()) waiting_.push({corners, distance, least});
  }

  Farthest Run() {
    while (!waiting_.empty() && waiting_.top().upper > Enough() && evaluated_ < kMaxPieces) {
      const Piece piece = waiting_.top();
      waiting_.pop();
      Split(piece);
    }
    return {found_, waiting_.empty() ? Enough() : std::max(Enough(), waiting_.top().upper)};
  }

  // Pieces with an upper bound below this are not evaluated [m].
  double Enough() const { return found_ + std::max(1e-4 * found_, 1e-9); }

 private:
  // Evaluates the four quarters of a piece.
  void Split(const Piece& piece) {
    const Eigen::Vector3d a = piece.corners.col(0), b = piece.corners.col(1), c = piece.corners.col(2);
    const Eigen::Vector3d ab = (a + b) / 2, bc = (b + c) / 2, ca = (c + a) / 2;
    const Eigen::Vector3d middle = piece.corners.rowwise().mean();
    const auto evaluate = [&](const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Eigen::Vector3d& r) {
      Eigen::Matrix3d corners;
      corners << p, q, r;
      Evaluate(corners, piece.distance + (corners.rowwise().mean() - middle).norm(), piece.upper);
    };
    evaluate(a, ab, ca);
    evaluate(ab, b, bc);
    evaluate(ca, bc, c);
    evaluate(ab, bc, ca);
  }

  const MeasuredSurface& to_;
  double found_;
  int evaluated_ = 0;
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
    if (upper > search.Enough()) search.Evaluate(corners, upper, upper);
  }
  return search.Run();
}

}  // namespace phrenic::compare
