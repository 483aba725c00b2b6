#include "server/fit/sides.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"

namespace phrenic::fit {
namespace {

constexpr double kWindow = 0.08;  // of the extent, in which points are counted
constexpr double kEmpty = 0.1;    // density of a gap, relative to the mean
constexpr double kCertain = 2;    // standard errors
constexpr int kWindows = 60;      // positions of the window
constexpr const char* kAxes[] = {"x", "y", "z"};

std::vector<double> Coordinates(const Points& points, int axis) {
  const Eigen::VectorXd row = points.row(axis);
  return {row.begin(), row.end()};
}

// The window of lowest density in the middle half of an extent.
struct Gap {
  double density = 1;  // relative to the mean
  double at = 0;       // its middle
};

Gap FindGap(const std::vector<double>& values) {
  const double low = Quantile(values, 0.02), extent = Quantile(values, 0.98) - low;
  const double mean = kWindow * static_cast<double>(values.size());
  Gap gap;
  double last = 0;  // the last window as empty as the first one found
  for (int i = 0; i < kWindows; ++i) {
    const double middle = low + extent * (0.25 + 0.5 * i / (kWindows - 1));
    const auto inside = [&](double v) { return std::abs(v - middle) < extent * kWindow / 2; };
    const double density = static_cast<double>(std::count_if(values.begin(), values.end(), inside)) / mean;
    if (density < gap.density) gap = {density, middle};
    if (density <= gap.density) last = middle;
  }
  return {gap.density, (gap.at + last) / 2};
}

Points Where(const Points& points, const std::vector<bool>& keep) {
  std::vector<int> indices;
  for (size_t i = 0; i < keep.size(); ++i) {
    if (keep[i]) indices.push_back(static_cast<int>(i));
  }
  return points(Eigen::all, indices);
}

// Returns the points with a coordinate between two fractions of all points in its order.
Points Slice(const Points& points, int axis, double from, double to) {
  const std::vector<double> values = Coordinates(points, axis);
  const double low = Quantile(values, from), high = Quantile(values, to);
  std::vector<bool> keep;
  keep.reserve(values.size());
  for (const double v : values) keep.push_back(v >= low && v <= high);
  return Where(points, keep);
}

double Deviation(const Points& points, int axis) {
  const Eigen::ArrayXd row = points.row(axis);
  return std::sqrt((row - row.mean()).square().mean());
}

double ShareAbove(const Points& points, int axis, double limit) {
  return static_cast<double>((points.row(axis).array() > limit).count()) /
         static_cast<double>(std::max<Eigen::Index>(1, points.cols()));
}

absl::Status CheckExtents(const Points& points) {
  constexpr double kLeast[] = {0.1, 0.06, 0.07}, kMost[] = {0.5, 0.4, 0.5};
  for (int axis = 0; axis < 3; ++axis) {
    const std::vector<double> values = Coordinates(points, axis);
    const double extent = Quantile(values, 0.995) - Quantile(values, 0.005);
    if (extent >= kLeast[axis] && extent <= kMost[axis]) continue;
    return absl::InvalidArgumentError(
        absl::StrFormat("the points extend %.4g mm along %s, lungs %g to %g mm: coordinates must be in mm and cover "
                        "both lungs",
                        1000 * extent, kAxes[axis], 1000 * kLeast[axis], 1000 * kMost[axis]));
  }
  return absl::OkStatus();
}

// Returns the gap along x, at mid-height, where heart and apices do not blur it.
absl::StatusOr<Gap> GapAlongX(const Points& points) {
  const Points middle = Slice(points, 2, 0.2, 0.9);
  const Gap x = FindGap(Coordinates(middle, 0));
  if (x.density <= kEmpty) return x;
  for (int axis = 1; axis < 3; ++axis) {
    if (FindGap(Coordinates(axis == 1 ? middle : points, axis)).density > kEmpty) continue;
    return absl::InvalidArgumentError(absl::StrCat("the gap between the lungs lies along ", kAxes[axis],
                                                   " and must lie along x: swap the columns x and ", kAxes[axis],
                                                   " (LPS: +x left, +y posterior, +z superior)"));
  }
  return absl::InvalidArgumentError(
      "there is no gap along x between a right and a left lung: the points must cover both lungs, in LPS (+x left, +y "
      "posterior, +z superior)");
}

// What tells one axis, in standard errors; positive if it is right.
struct AxisSign {
  double errors;
  const char* wrong;  // what is wrong if it is negative, and the remedy
  const char* doubt;  // what is not known otherwise
};

// The lungs' widths: ln of base over apex, of both lungs. The error of ln of a deviation of m points is 1/sqrt(2 m).
double WidthSign(const Points& right, const Points& left) {
  double sum = 0, variance = 0;
  for (const Points* lung : {&right, &left}) {
    const Points base = Slice(*lung, 2, 0, 0.2), apex = Slice(*lung, 2, 0.8, 1);
    sum += std::log(Deviation(base, 0) / Deviation(apex, 0));
    variance += 0.5 / static_cast<double>(base.cols()) + 0.5 / static_cast<double>(apex.cols());
  }
  return sum / std::sqrt(variance);
}

// The share of the apices' points that lies at the back.
double ApexSign(const Points& points) {
  const std::vector<double> y = Coordinates(points, 1);
  const Points top = Slice(points, 2, 0.7, 1);
  const double share = ShareAbove(top, 1, (Quantile(y, 0.01) + Quantile(y, 0.99)) / 2);
  return (share - 0.5) * std::sqrt(4.0 * static_cast<double>(top.cols()));
}

// The share of low points that is in the left lung: less in front, where the heart is, than at the back.
double HeartSign(const Points& points, double gap) {
  const Points low = Slice(points, 2, 0, 0.4), front = Slice(low, 1, 0, 0.4), back = Slice(low, 1, 0.6, 1);
  const double of_front = ShareAbove(front, 0, gap), of_back = ShareAbove(back, 0, gap);
  const double share = (of_front + of_back) / 2, both = static_cast<double>(std::min(front.cols(), back.cols()));
  return (of_back - of_front) / std::sqrt(2 * std::max(share * (1 - share), 1e-3) / both);
}

absl::Status CheckAxes(const Points& points, const Points& right, const Points& left, LungSides& sides) {
  const AxisSign signs[] = {
      {WidthSign(right, left),
       "the lungs are wider at the top than at the base: +z must be superior; reverse the sign of z",
       "the points do not tell whether +z is superior"},
      {ApexSign(points),
       "the apices of the lungs lie in front: +y must be posterior; reverse the sign of y, or of x and y if the points "
       "are RAS (a first line \"# space=ras\" does that)",
       "the points do not tell whether +y is posterior"},
      {HeartSign(points, sides.gap),
       "the heart seems to lie on the right: +x must be the patient's left; reverse the sign of x",
       "the points do not tell whether +x is the patient's left"},
  };
  for (const AxisSign& sign : signs) {
    if (!(sign.errors > -kCertain)) return absl::InvalidArgumentError(sign.wrong);
    if (sign.errors < kCertain) sides.doubts.push_back(absl::StrCat(sign.doubt, ": check the axes"));
  }
  return absl::OkStatus();
}

}  // namespace

double Quantile(std::vector<double> values, double q) {
  const double at = q * static_cast<double>(values.size() - 1);
  const auto below = values.begin() + static_cast<std::ptrdiff_t>(at);
  std::nth_element(values.begin(), below, values.end());
  const double low = *below;
  if (below + 1 == values.end()) return low;
  return low + (at - std::floor(at)) * (*std::min_element(below + 1, values.end()) - low);
}

absl::StatusOr<LungSides> FindSides(const Points& points) {
  if (!points.allFinite()) return absl::InvalidArgumentError("a coordinate of the points is not a finite number");
  if (points.cols() < kFewestPoints) {
    return absl::InvalidArgumentError(
        absl::StrCat("there are ", points.cols(), " points in the lungs; their shape needs ", kFewestPoints));
  }
  if (absl::Status status = CheckExtents(points); !status.ok()) return status;
  const absl::StatusOr<Gap> gap = GapAlongX(points);
  if (!gap.ok()) return gap.status();
  LungSides sides;
  sides.gap = gap->at;
  for (const double x : points.row(0)) sides.of.push_back(x > gap->at ? kLeft : kRight);
  const Points right = points(Eigen::all, PointsOf(sides, kRight)), left = points(Eigen::all, PointsOf(sides, kLeft));
  if (std::min(right.cols(), left.cols()) < kFewestPoints / 4) {
    return absl::InvalidArgumentError(absl::StrCat("the right lung has ", right.cols(), " points, the left ",
                                                   left.cols(), "; each needs ", kFewestPoints / 4));
  }
  if (absl::Status status = CheckAxes(points, right, left, sides); !status.ok()) return status;
  return sides;
}

std::vector<int> PointsOf(const LungSides& sides, Side side) {
  std::vector<int> indices;
  for (size_t i = 0; i < sides.of.size(); ++i) {
    if (sides.of[i] == side) indices.push_back(static_cast<int>(i));
  }
  return indices;
}

}  // namespace phrenic::fit
