#include "server/compare/doubts.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/mesh/units.h"

namespace phrenic::compare {
namespace {

constexpr double kSizeRatio = 3;    // two scans of one organ differ by less
constexpr double kApart = 0.5;      // mean distance, in sizes of the larger surface
constexpr double kOffCentre = 0.1;  // distance of the centres, in sizes: less is no sign of a wrong frame
constexpr double kMuchNearer = 0.3;

// The bounding box of a surface.
struct Box {
  Eigen::Vector3d low, high;  // [m]

  double size() const { return (high - low).norm(); }
  Eigen::Vector3d centre() const { return (low + high) / 2; }
};

Box BoxOf(const MeasuredSurface& surface) {
  const auto used = surface.vertices()(Eigen::all, surface.used());
  return {used.rowwise().minCoeff(), used.rowwise().maxCoeff()};
}

std::string Millimetres(double metres) { return absl::StrFormat("%.4g mm", kMillimetresAMetre * metres); }

// Returns the ratio of two usual units (mm, cm, m, inch, micrometre) that is within 25 % of `ratio`; 0 if no two
// are.
double RatioOfUnits(double ratio) {
  for (const double known : {10.0, 25.4, 100.0, 1000.0, 1e6}) {
    if (std::abs(std::log(ratio / known)) < std::log(1.25)) return known;
  }
  return 0;
}

std::string SizeDoubt(double a, double b) {
  const double ratio = std::max(a, b) / std::min(a, b);
  if (!(ratio > kSizeRatio)) return "";
  const char* const smaller = a < b ? "A" : "B";
  std::string text = absl::StrFormat("A is %s across and B %s, %.3g times as %s", Millimetres(a), Millimetres(b), ratio,
                                     a < b ? "large" : "small");
  if (const double units = RatioOfUnits(ratio); units > 0) {
    absl::StrAppendFormat(&text, ": is the unit of %s %g times as long as assumed (--unit-a, --unit-b)?", smaller,
                          units);
  } else {
    text += ": are they the same part, and their units right (--unit-a, --unit-b)?";
  }
  return text;
}

std::string FrameDoubt(const Box& a, const Box& b, double size) {
  const Eigen::Vector3d turned = b.centre().cwiseProduct(Eigen::Vector3d(-1, -1, 1));
  const double now = (a.centre() - b.centre()).norm(), then = (a.centre() - turned).norm();
  if (now < kOffCentre * size || then > kMuchNearer * now) return "";
  return absl::StrFormat(
      "the centres are %s apart, but %s if x and y of one surface are negated: is one file in RAS? State SPACE=RAS in "
      "it",
      Millimetres(now), Millimetres(then));
}

}  // namespace

std::vector<std::string> Doubts(const MeasuredSurface& a, const MeasuredSurface& b, double mean) {
  std::vector<std::string> doubts;
  if (a.empty() || b.empty()) return doubts;
  const Box box_a = BoxOf(a), box_b = BoxOf(b);
  const double size = std::max(box_a.size(), box_b.size());
  if (!(size > 0)) return doubts;
  doubts.push_back(SizeDoubt(box_a.size(), box_b.size()));
  doubts.push_back(FrameDoubt(box_a, box_b, size));
  if (mean > kApart * size) {
    doubts.push_back(
        absl::StrFormat("the mean distance is %s, but the larger surface is only %s across: the surfaces lie in "
                        "different places; check "
                        "units and frames",
                        Millimetres(mean), Millimetres(size)));
  }
  std::erase(doubts, "");
  return doubts;
}

}  // namespace phrenic::compare
