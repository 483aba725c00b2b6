#include "server/compare/surface_samples.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "absl/strings/str_format.h"
#include "server/mesh/units.h"

namespace phrenic::compare {
namespace {

constexpr double kWanted = 5e4;  // samples of a surface if no spacing is given
constexpr double kMost = 5e6;    // largest number of samples if a spacing is given

struct Corners {
  Corners(const ConstPoints& x, const Triangles& triangles, Eigen::Index t)
      : a(x.col(triangles(0, t))), b(x.col(triangles(1, t))), c(x.col(triangles(2, t))) {}
  double LongestEdge() const { return std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()}); }
  double Area() const { return (b - a).cross(c - a).norm() / 2; }
  Eigen::Vector3d a, b, c;
};

// Returns into how many parts an edge is divided. The tolerance avoids an extra part if the edge is a multiple of the
// spacing.
double PartsOf(double edge, double spacing) { return std::max(1.0, std::ceil(edge / spacing * (1 - 1e-12))); }

double CountSamples(const ConstPoints& x, const Triangles& triangles, double spacing) {
  double samples = 0;
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    const double parts = PartsOf(Corners(x, triangles, t).LongestEdge(), spacing);
    samples += parts * parts;
  }
  return samples;
}

// Returns the spacing [m] for kWanted samples. An equilateral part with edge s has the area sqrt(3)/4 s^2. Slivers have
// less area for their longest edge: then the spacing grows until there are not too many samples.
double AutomaticSpacing(const ConstPoints& x, const Triangles& triangles) {
  double area = 0;
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) area += Corners(x, triangles, t).Area();
  if (!(area > 0)) return std::numeric_limits<double>::infinity();
  constexpr double kTooMany = 2;
  const double enough = kTooMany * std::max(kWanted, static_cast<double>(triangles.cols()));
  double spacing = std::sqrt(4 / std::numbers::sqrt3 * area / kWanted);
  while (CountSamples(x, triangles, spacing) > enough) spacing *= std::numbers::sqrt2;
  return spacing;
}

}  // namespace

absl::StatusOr<Sampling> PlanSampling(const ConstPoints& x, const Triangles& triangles, std::optional<double> spacing) {
  Sampling sampling;
  sampling.spacing = spacing ? *spacing : AutomaticSpacing(x, triangles);
  const double samples = CountSamples(x, triangles, sampling.spacing);
  if (spacing && samples > std::max(kMost, static_cast<double>(triangles.cols()))) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "spacing_mm: %g mm needs %.3g samples of a surface, above the limit of %g; about %.2g mm is the least for this "
        "surface",
        kMillimetresAMetre * *spacing, samples, kMost,
        1.05 * kMillimetresAMetre * *spacing * std::sqrt(samples / kMost)));
  }
  sampling.samples = static_cast<std::int64_t>(samples);
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    const double edge = Corners(x, triangles, t).LongestEdge();
    sampling.longest = std::max(sampling.longest, edge / PartsOf(edge, sampling.spacing));
  }
  return sampling;
}

void ForEachSample(const ConstPoints& x, const Triangles& triangles, const Sampling& sampling,
                   absl::FunctionRef<void(const Eigen::Vector3d& point, double area)> visit) {
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    const Corners corners(x, triangles, t);
    const int n = static_cast<int>(PartsOf(corners.LongestEdge(), sampling.spacing));
    const Eigen::Vector3d ab = (corners.b - corners.a) / n, ac = (corners.c - corners.a) / n;
    const double area = corners.Area() / n / n;
    for (int i = 0; i < n; ++i) {
      for (int j = 0; i + j < n; ++j) {
        visit(corners.a + (i + 1.0 / 3) * ab + (j + 1.0 / 3) * ac, area);
        if (i + j + 1 < n) visit(corners.a + (i + 2.0 / 3) * ab + (j + 2.0 / 3) * ac, area);
      }
    }
  }
}

}  // namespace phrenic::compare
