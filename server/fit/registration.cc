#include "server/fit/registration.h"

#include <algorithm>
#include <cmath>
#include <nlopt.hpp>
#include <stdexcept>

#include "absl/strings/str_format.h"
#include "server/fit/sides.h"
#include "server/mesh/triangle_tree.h"

namespace phrenic::fit {
namespace {

constexpr double kSpacing = 0.004, kPad = 0.03;  // of the distance's grid [m]
constexpr double kMargin = 2, kRobust = 6;       // [mm]
constexpr double kSpread = 0.3;                  // of ln(s/s0)
constexpr int kMostPoints = 700, kTries = 600;
constexpr double kShiftUnit = 0.01;  // [m] of a number that is searched

double SignedDistance(const TriangleTree& tree, const TriangleTree::Boxes& boxes, const Points& x,
                      const Eigen::Vector3d& point) {
  const SurfacePoint nearest = tree.Nearest(x, boxes, point, std::numeric_limits<double>::infinity());
  return (nearest.facing > 0 ? -1 : 1) * std::sqrt(nearest.squared);
}

double Penalty(double outside_mm) {
  if (outside_mm <= 0) return 0;
  return outside_mm < kRobust ? outside_mm * outside_mm : kRobust * kRobust + 2 * (outside_mm - kRobust);
}

// The search's objective. Its numbers are ln(s/s0) and the shift of the centre in units of kShiftUnit.
class Objective {
 public:
  Objective(const LungTemplate& lung, const Points& points) : lung_(lung) {
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::VectorXd row = points.row(axis);
      const std::vector<double> values(row.begin(), row.end());
      const double low = Quantile(values, 0.005), high = Quantile(values, 0.995);
      scale_[axis] = 1.03 * (high - low) / lung.box().sizes()[axis];
      centre_[axis] = (low + high) / 2;
    }
    const Eigen::Index count = std::min<Eigen::Index>(points.cols(), kMostPoints);
    points_.resize(3, count);
    for (Eigen::Index i = 0; i < count; ++i) points_.col(i) = points.col(i * points.cols() / count);
  }

  Registration At(const std::vector<double>& v) const {
    Registration r;
    r.scale = scale_.array() * Eigen::Array3d(v[0], v[1], v[2]).exp();
    r.shift = centre_ + kShiftUnit * Eigen::Vector3d(v[3], v[4], v[5]) - r.scale.cwiseProduct(lung_.box().center());
    return r;
  }

  double Value(const std::vector<double>& v) const {
    const Registration r = At(v);
    const double millimetres = 1000 * std::cbrt(r.scale.prod());
    double sum = 0;
    for (const auto& p : points_.colwise()) {
      sum += Penalty(lung_.DistanceAt(r.ToTemplate(p)) * millimetres + kMargin);
    }
    const Eigen::Vector3d a(v[0], v[1], v[2]);
    return 2 * sum / static_cast<double>(points_.cols()) + 1.5 * a.sum() + a.squaredNorm() / (kSpread * kSpread);
  }

 private:
  const LungTemplate& lung_;
  Eigen::Vector3d scale_, centre_;
  Points points_;
};

double ObjectiveValue(const std::vector<double>& v, std::vector<double>&, void* data) {
  return static_cast<const Objective*>(data)->Value(v);
}

std::vector<double> SearchLeast(Objective& objective) {
  nlopt::opt search(nlopt::LN_BOBYQA, 6);
  search.set_min_objective(ObjectiveValue, &objective);
  search.set_lower_bounds(std::vector<double>{-0.7, -0.7, -0.7, -4, -4, -4});
  search.set_upper_bounds(std::vector<double>{0.7, 0.7, 0.7, 4, 4, 4});
  search.set_initial_step(std::vector<double>{0.05, 0.05, 0.05, 0.3, 0.3, 0.3});
  search.set_xtol_abs(1e-4);
  search.set_maxeval(kTries);
  std::vector<double> v(6, 0.0);
  double least = 0;
  try {
    search.optimize(v, least);
  } catch (const std::runtime_error&) {  // rounding ends the search; v is the best point so far
  }
  return v;
}

void MeasureOutside(const LungTemplate& lung, const Points& points, Registration& r) {
  const double scale = std::cbrt(r.scale.prod());
  int outside = 0;
  for (const auto& p : points.colwise()) {
    const double distance = scale * lung.DistanceAt(r.ToTemplate(p));
    outside += distance > 0 ? 1 : 0;
    r.farthest = std::max(r.farthest, distance);
  }
  r.outside = static_cast<double>(outside) / static_cast<double>(points.cols());
}

}  // namespace

LungTemplate::LungTemplate(Mesh surface) : surface_(std::move(surface)) {
  for (const auto& vertex : surface_.vertices.colwise()) box_.extend(vertex);
  origin_ = box_.min().array() - kPad;
  size_ = ((box_.sizes().array() + 2 * kPad) / kSpacing).ceil().cast<int>() + 1;
  distance_.resize(size_.prod());
  const TriangleTree tree(surface_.vertices, surface_.triangles);
  TriangleTree::Boxes boxes;
  tree.Fit(surface_.vertices, boxes);
  Eigen::Index at = 0;
  for (int k = 0; k < size_.z(); ++k) {
    for (int j = 0; j < size_.y(); ++j) {
      for (int i = 0; i < size_.x(); ++i) {
        distance_[at++] = SignedDistance(tree, boxes, surface_.vertices, origin_ + kSpacing * Eigen::Vector3d(i, j, k));
      }
    }
  }
}

double LungTemplate::DistanceAt(const Eigen::Vector3d& point) const {
  const Eigen::Array3d at =
      ((point - origin_) / kSpacing).array().max(0.0).min((size_.array() - 1).cast<double>() - 1e-9);
  const Eigen::Array3i cell = at.cast<int>();
  const Eigen::Array3d t = at - cell.cast<double>();
  double sum = 0;
  for (int c = 0; c < 8; ++c) {
    const int i = c & 1, j = c >> 1 & 1, k = c >> 2;
    const double weight = (i == 1 ? t[0] : 1 - t[0]) * (j == 1 ? t[1] : 1 - t[1]) * (k == 1 ? t[2] : 1 - t[2]);
    sum += weight * Node(cell[0] + i, cell[1] + j, cell[2] + k);
  }
  return sum;
}

Mesh Registration::Apply(Mesh surface) const {
  surface.vertices = (scale.asDiagonal() * surface.vertices).colwise() + shift;
  return surface;
}

absl::StatusOr<Registration> Register(const LungTemplate& lung, const Points& points) {
  Objective objective(lung, points);
  Registration r = objective.At(SearchLeast(objective));
  if (r.scale.minCoeff() < 0.4 || r.scale.maxCoeff() > 2.5) {
    return absl::FailedPreconditionError(
        absl::StrFormat("the generated lung would have to be scaled by %.2g, %.2g, %.2g: the points do not fill a lung",
                        r.scale.x(), r.scale.y(), r.scale.z()));
  }
  MeasureOutside(lung, points, r);
  return r;
}

}  // namespace phrenic::fit
