#include <algorithm>
#include <cmath>

#include "server/physiology/measures.h"

namespace phrenic::physiology {
namespace {

constexpr double kMillimetres = 1e3;
constexpr double kSpeedOver = 0.1;  // [s]

double Fall(const Recording& r, Quantity column) {
  const auto& height = r.of[column];
  return kMillimetres * (height.front() - *std::min_element(height.begin(), height.end()));
}

double Rise(const Recording& r, Quantity column) {
  const auto& height = r.of[column];
  return kMillimetres * (*std::max_element(height.begin(), height.end()) - height.front());
}

double FallAtPeak(const Recording& r, Quantity column) {
  return kMillimetres * (r.of[column].front() - r.of[column][r.peak_sample]);
}

Points SheetAt(const Recording& r, const State& state) {
  return Placed(r.subject->model, state, r.subject->parts.sheet);
}

}  // namespace

double RightApex(const Recording& r, const Recording&) { return Fall(r, kRightApex); }
double RightBack(const Recording& r, const Recording&) { return Fall(r, kRightBack); }
double LeftApex(const Recording& r, const Recording&) { return Fall(r, kLeftApex); }
double LeftBack(const Recording& r, const Recording&) { return Fall(r, kLeftBack); }
double RightApexOrBack(const Recording& r, const Recording&) {
  return std::max(Fall(r, kRightApex), Fall(r, kRightBack));
}
double LeftOverRight(const Recording& r, const Recording&) { return Fall(r, kLeftApex) / Fall(r, kRightApex); }

double BackOverFront(const Recording& r, const Recording&) {
  return r.subject->columns.BackOverFront(SheetAt(r, r.base), SheetAt(r, r.peak));
}

double RightMean(const Recording& r, const Recording&) {
  return kMillimetres * r.subject->columns.MeanDescent(SheetAt(r, r.base), SheetAt(r, r.peak), v1::SIDE_RIGHT);
}

double LeftMean(const Recording& r, const Recording&) {
  return kMillimetres * r.subject->columns.MeanDescent(SheetAt(r, r.base), SheetAt(r, r.peak), v1::SIDE_LEFT);
}

double DomeSpeed(const Recording& r, const Recording&) {
  const auto& height = r.of[kRightApex];
  double speed = 0;
  for (size_t i = 0, j = 0; j < height.size(); ++j) {
    while (r.time[j] - r.time[i] > kSpeedOver * 1.1) ++i;
    if (r.time[j] - r.time[i] < kSpeedOver * 0.9) continue;
    speed = std::max(speed, (height[i] - height[j]) / (r.time[j] - r.time[i]));
  }
  return kMillimetres * speed;
}

double DomeMotion(const Recording& r, const Recording&) {
  return std::max({Fall(r, kRightApex), Rise(r, kRightApex), Fall(r, kLeftApex), Rise(r, kLeftApex)});
}

double RightRise(const Recording& r, const Recording&) { return Rise(r, kRightApex); }
double LeftRise(const Recording& r, const Recording&) { return Rise(r, kLeftApex); }
double BothRise(const Recording& r, const Recording&) {
  return -std::max(FallAtPeak(r, kRightApex), FallAtPeak(r, kLeftApex));
}
double LesserDescent(const Recording& r, const Recording&) {
  return std::min(FallAtPeak(r, kRightApex), FallAtPeak(r, kLeftApex));
}

double ApexAbove(const Recording& r, const Recording& other) {
  return kMillimetres * (r.of[kRightApex].front() - other.of[kRightApex].front());
}

double DescentShare(const Recording& r, const Recording& other) {
  return 100 * RightApexOrBack(r, r) / RightApexOrBack(other, other);
}

}  // namespace phrenic::physiology
