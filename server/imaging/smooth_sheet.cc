#include "server/imaging/smooth_sheet.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>

namespace phrenic::imaging {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

constexpr double kBending = 2;  // b, relative to a weight of 1 per ray
constexpr double kOff = 6;      // scale of the robust weight [mm]
constexpr double kAgrees = 8;   // maximum residual of evidence that SourceAt reports [mm]
constexpr double kNearby = 10;  // maximum distance of evidence that SourceAt reports [mm]

// Returns the five-point Laplacian at interior grid points, and second differences along the grid's edges.
Sparse Laplacian(const SheetEvidence& grid) {
  std::vector<Eigen::Triplet<double>> entries;
  const int last = grid.count - 1;
  for (int j = 0; j <= last; ++j) {
    for (int i = 0; i <= last; ++i) {
      const int at = grid.Index(i, j);
      const auto along = [&](int before, int after) {
        entries.emplace_back(at, at, -2);
        entries.emplace_back(at, before, 1);
        entries.emplace_back(at, after, 1);
      };
      if (i > 0 && i < last) along(grid.Index(i - 1, j), grid.Index(i + 1, j));
      if (j > 0 && j < last) along(grid.Index(i, j - 1), grid.Index(i, j + 1));
    }
  }
  Sparse laplacian(grid.count * grid.count, grid.count * grid.count);
  laplacian.setFromTriplets(entries.begin(), entries.end());
  return laplacian;
}

double Square(double x) { return x * x; }

// Minimises by iteratively reweighted least squares.
Eigen::VectorXd Fit(const SheetEvidence& evidence) {
  constexpr int kRounds = 4;
  const int n = evidence.count * evidence.count;
  const Sparse laplacian = Laplacian(evidence);
  const Sparse bending = kBending * Sparse(laplacian.transpose()) * laplacian;
  const Eigen::Map<const Eigen::VectorXd> observed(evidence.depth.data(), n);
  Eigen::VectorXd weights(n), depth;
  for (int i = 0; i < n; ++i) weights[i] = evidence.source[i] == Source::kNone ? 0 : 1;
  Eigen::SimplicialLDLT<Sparse> solver;
  for (int round = 0; round < kRounds; ++round) {
    Sparse system = bending;
    system.diagonal() += (weights.array() + 1e-9).matrix();
    if (round == 0) solver.analyzePattern(system);
    solver.factorize(system);
    depth = solver.solve(weights.cwiseProduct(observed));
    for (int i = 0; i < n; ++i) {
      if (evidence.source[i] != Source::kNone) weights[i] = 1 / (1 + Square((depth[i] - observed[i]) / kOff));
    }
  }
  return depth;
}

// Returns the uniform cubic B-spline's basis at t in [0, 1].
std::array<double, 4> SplineWeights(double t) {
  const double u = 1 - t;
  return {u * u * u / 6, (3 * t * t * t - 6 * t * t + 4) / 6, (3 * u * u * u - 6 * u * u + 4) / 6, t * t * t / 6};
}

}  // namespace

SmoothSheet::SmoothSheet(const CageFrame& frame, const SheetEvidence& evidence)
    : frame_(frame), evidence_(evidence), depth_(Fit(evidence)) {}

double SmoothSheet::Depth(const Eigen::Vector2d& p) const {
  const Eigen::Array2d at = ((p.array() + kPlaneReach) / evidence_.cell()).max(1.0).min(evidence_.count - 2.001);
  const int i = static_cast<int>(at.x()), j = static_cast<int>(at.y());
  const std::array<double, 4> across = SplineWeights(at.x() - i), along = SplineWeights(at.y() - j);
  double depth = 0;
  for (int b = 0; b < 4; ++b) {
    for (int a = 0; a < 4; ++a) depth += across[a] * along[b] * depth_[evidence_.Index(i + a - 1, j + b - 1)];
  }
  return depth;
}

Eigen::Vector3d SmoothSheet::Normal(const Eigen::Vector2d& p) const {
  constexpr double kStep = 5e-3;
  const Eigen::Vector2d ex(kStep, 0), ey(0, kStep);
  return (Point(p + ex) - Point(p - ex)).cross(Point(p + ey) - Point(p - ey)).normalized();
}

Eigen::Vector2d SmoothSheet::AtHeight(const Eigen::Vector2d& azimuth, double z) const {
  double inner = kPlaneReach;
  constexpr double kStep = 0.01;
  while (inner > kStep && Point(azimuth * inner).z() < z) inner -= kStep;
  double outer = std::min(inner + kStep, kPlaneReach);
  for (int i = 0; i < 30; ++i) {
    const double middle = (inner + outer) / 2;
    (Point(azimuth * middle).z() > z ? inner : outer) = middle;
  }
  return azimuth * inner;
}

Source SmoothSheet::SourceAt(const Eigen::Vector2d& p) const {
  const Eigen::Vector3d here = Point(p);
  const Eigen::Array2d at = (p.array() + kPlaneReach) / evidence_.cell();
  constexpr int kAround = 5;
  double nearest = kNearby;
  Source source = Source::kNone;
  for (int j = static_cast<int>(at.y()) - kAround; j <= static_cast<int>(at.y()) + kAround; ++j) {
    for (int i = static_cast<int>(at.x()) - kAround; i <= static_cast<int>(at.x()) + kAround; ++i) {
      if (i < 0 || j < 0 || i >= evidence_.count || j >= evidence_.count) continue;
      const int index = evidence_.Index(i, j);
      if (evidence_.source[index] == Source::kNone) continue;
      if (std::abs(evidence_.depth[index] - depth_[index]) > kAgrees) continue;
      const double distance = (frame_.RayOf(evidence_.Plane(i, j)).At(depth_[index]) - here).norm();
      if (distance < nearest) nearest = distance, source = evidence_.source[index];
    }
  }
  return source;
}

}  // namespace phrenic::imaging
