#include "server/imaging/slice_stack.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "absl/strings/str_cat.h"
#include "server/imaging/label_volume.h"

namespace phrenic::imaging {
namespace {

constexpr double kRounding = 0.02;  // of written positions [mm]
constexpr double kOffGrid = 0.1;    // largest deviation from the grid, in voxels
constexpr const char* kResample = "; resample the segmentation to one grid, for example in 3D Slicer";

// Positions at different heights along the normal, ascending.
struct Levels {
  std::vector<Eigen::Vector3d> first;  // a position at each
  std::vector<int> level_of;           // of each position
  std::vector<double> gaps;            // between neighbours [mm]
};

Levels FindLevels(const Eigen::Vector3d& normal, const std::vector<Eigen::Vector3d>& positions) {
  std::vector<int> order(positions.size());
  std::iota(order.begin(), order.end(), 0);
  const auto height = [&](int p) { return normal.dot(positions[p]); };
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return height(a) < height(b); });
  Levels levels;
  levels.level_of.resize(positions.size());
  for (const int p : order) {
    const double gap = levels.first.empty() ? 0 : height(p) - normal.dot(levels.first.back());
    if (levels.first.empty() || gap > kRounding) {
      if (!levels.first.empty()) levels.gaps.push_back(gap);
      levels.first.push_back(positions[p]);
    }
    levels.level_of[p] = static_cast<int>(levels.first.size()) - 1;
  }
  return levels;
}

// True if all gaps are multiples of the step.
bool AreMultiples(const std::vector<double>& gaps, double step) {
  return std::all_of(gaps.begin(), gaps.end(), [step](double gap) {
    const double count = std::round(gap / step);
    return count >= 1 && std::abs(gap - count * step) <= kOffGrid * step;
  });
}

// Returns the mean of the gaps that are as small as the smallest.
double SmallestGap(const std::vector<double>& gaps) {
  const double least = *std::min_element(gaps.begin(), gaps.end());
  double sum = 0;
  int count = 0;
  for (const double gap : gaps) {
    if (gap > (1 + kOffGrid) * least) continue;
    sum += gap;
    ++count;
  }
  return sum / count;
}

absl::StatusOr<double> StepOf(const std::vector<double>& gaps, double stated) {
  if (gaps.empty()) {
    if (stated > 0) return stated;
    return absl::InvalidArgumentError(
        "it has a single slice, whose thickness is not stated; save the segmentation of the whole thorax");
  }
  const double least = SmallestGap(gaps);
  for (const double step : {least, stated}) {
    if (step > 0 && AreMultiples(gaps, step)) return step;
  }
  return absl::InvalidArgumentError(absl::StrCat("its slices are not equidistant: neighbours are ", least, " to ",
                                                 *std::max_element(gaps.begin(), gaps.end()), " mm apart", kResample));
}

// Returns each level's slice. Empty if there are more than kMaxAlong.
std::vector<int> SlicesOf(const std::vector<double>& gaps, double step) {
  std::vector<int> slices = {0};
  for (const double gap : gaps) {
    const double next = slices.back() + std::round(gap / step);
    if (!(next < kMaxAlong)) return {};
    slices.push_back(static_cast<int>(next));
  }
  return slices;
}

absl::Status CheckGrid(const SliceStack& stack, const std::vector<Eigen::Vector3d>& positions) {
  if (!IsVoxelFrame(stack.to_patient)) {
    return absl::InvalidArgumentError(absl::StrCat("its slices do not make a grid with ", kVoxelFrameRule, kResample));
  }
  const double allowed = kRounding + kOffGrid * stack.to_patient.linear().colwise().norm().minCoeff();
  for (std::size_t p = 0; p < positions.size(); ++p) {
    const double off = (stack.to_patient * Eigen::Vector3d(0, 0, stack.slice_of[p]) - positions[p]).norm();
    if (off <= allowed) continue;
    return absl::InvalidArgumentError(
        absl::StrCat("frame ", p + 1, " is ", off, " mm beside the grid of the other frames", kResample));
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<SliceStack> StackSlices(const SlicePlane& plane, const std::vector<Eigen::Vector3d>& positions,
                                       double stated) {
  const Eigen::Vector3d normal = plane.along_row.cross(plane.along_column).normalized();
  const Levels levels = FindLevels(normal, positions);
  const absl::StatusOr<double> step = StepOf(levels.gaps, stated);
  if (!step.ok()) return step.status();
  const std::vector<int> slices = SlicesOf(levels.gaps, *step);
  if (slices.empty()) {
    return absl::InvalidArgumentError(absl::StrCat("its slices, ", *step, " mm apart, span more than ", kMaxAlong,
                                                   " of them; crop the segmentation to the thorax"));
  }
  SliceStack stack;
  stack.slices = slices.back() + 1;
  for (const int level : levels.level_of) stack.slice_of.push_back(slices[level]);
  const Eigen::Vector3d along = stack.slices == 1
                                    ? Eigen::Vector3d(*step * normal)
                                    : Eigen::Vector3d((levels.first.back() - levels.first.front()) / slices.back());
  stack.to_patient = Eigen::Affine3d::Identity();
  stack.to_patient.linear() << plane.along_row, plane.along_column, along;
  stack.to_patient.translation() = levels.first.front();
  if (absl::Status status = CheckGrid(stack, positions); !status.ok()) return status;
  return stack;
}

}  // namespace phrenic::imaging
