#include "server/fluoroscopy/c_arm.h"

#include <cmath>
#include <numbers>
#include <string>

#include "absl/strings/str_cat.h"

namespace phrenic::fluoroscopy {
namespace {

constexpr std::pair<std::string_view, double> kViews[] = {
    {"pa", 0}, {"ap", 180}, {"left-lateral", 90}, {"lao-30", 30}, {"rao-30", -30}};

}  // namespace

Projection ProjectionOf(const CArm& arm, const Eigen::Vector3d& isocentre) {
  const double a = arm.lao * std::numbers::pi / 180, b = arm.cranial * std::numbers::pi / 180;
  const double sa = std::sin(a), ca = std::cos(a), sb = std::sin(b), cb = std::cos(b);
  Projection projection;
  projection.isocentre = isocentre;
  projection.to_detector = {sa * cb, -ca * cb, sb};
  projection.right = {ca, sa, 0};
  projection.up = {-sa * sb, ca * sb, cb};
  if (arm.source_to_detector > 0) projection.source_distance = arm.source_to_detector - kIsocentreToDetector;
  return projection;
}

bool IsMirrored(const CArm& arm) { return std::abs(arm.lao) > 90; }

absl::StatusOr<CArm> NamedArm(std::string_view name) {
  for (const auto& [known, lao] : kViews) {
    if (known == name) return CArm{.lao = lao};
  }
  return absl::InvalidArgumentError(
      absl::StrCat("view \"", std::string(name), "\": the views are pa, ap, left-lateral, lao-30 and rao-30"));
}

}  // namespace phrenic::fluoroscopy
