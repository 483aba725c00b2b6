#include "server/imaging/smooth_sheet.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "server/imaging/thin_plate.h"

namespace phrenic::imaging {
namespace {

// b, relative to a weight of 1 per ray, and the scale of the robust weight [mm].
struct Smoothing {
  double bending, off;
};
constexpr Smoothing kUsual = {4, 6};
constexpr Smoothing kLabelled = {0.3, 30};  // rays are certain, and meet the sheet beside the spine at small angles

constexpr double kAgrees = 8;   // maximum residual of evidence that SourceAt reports [mm]
constexpr double kNearby = 10;  // maximum distance of evidence that SourceAt reports [mm]

double Square(double x) { return x * x; }

// Minimises by iteratively reweighted least squares.
Eigen::VectorXd FitDepths(const SheetEvidence& evidence) {
  constexpr int kRounds = 4;
  const int n = evidence.count * evidence.count;
  const bool labelled = std::ranges::find(evidence.source, Source::kLabel) != evidence.source.end();
  const Smoothing smoothing = labelled ? kLabelled : kUsual;
  ThinPlate plate({evidence.count, evidence.count}, smoothing.bending);
  const Eigen::Map<const Eigen::VectorXd> observed(evidence.depth.data(), n);
  Eigen::VectorXd weights(n), depth;
  for (int i = 0; i < n; ++i) weights[i] = evidence.source[i] == Source::kNone ? 0 : 1;
  for (int round = 0; round < kRounds; ++round) {
    depth = plate.Fit(weights, observed);
    for (int i = 0; i < n; ++i) {
      if (evidence.source[i] != Source::kNone) weights[i] = 1 / (1 + Square((depth[i] - observed[i]) / smoothing.off));
    }
  }
  return depth;
}

}  // namespace

SmoothSheet::SmoothSheet(const CageFrame& frame, const SheetEvidence& evidence)
    : frame_(frame), evidence_(evidence), depth_(FitDepths(evidence)) {}

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
      if (evidence_.source[index] == Source::kNone || evidence_.source[index] == Source::kOnWall) continue;
      if (std::abs(evidence_.depth[index] - depth_[index]) > kAgrees) continue;
      const double distance = (frame_.RayOf(evidence_.Plane(i, j)).At(depth_[index]) - here).norm();
      if (distance < nearest) nearest = distance, source = evidence_.source[index];
    }
  }
  return source;
}

}  // namespace phrenic::imaging
