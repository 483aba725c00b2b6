#include "server/anatomy/sternum.h"

#include <algorithm>
#include <cmath>

#include "server/anatomy/dimensions.h"
#include "server/anatomy/meshing/implicit_surface.h"
#include "server/anatomy/meshing/smooth.h"

namespace phrenic::anatomy {
namespace {

constexpr double kAngle = 317;    // sternal angle, where manubrium and body meet [mm]
constexpr double kBodyEnd = 214;  // z where the xiphoid begins [mm]
constexpr double kNotch = 358;    // z of the jugular notch [mm]
constexpr double kXiphoidTip = 184;
constexpr double kOverlap = 2;  // of the xiphoid with the body, so that no gap is seen [mm]
constexpr int kCostalNotches = 7;
constexpr double kRounded = 5;  // blending width at the edges [mm]

// The fields below are approximate signed distances [mm], negative inside, at a point that is mirrored to x >= 0.

// Between the anterior and the posterior face of a plate.
double BetweenFaces(const Eigen::Vector3d& x, double half_thickness) {
  constexpr double kStep = 0.5;
  const double slope = (SternumLine(x.z() + kStep) - SternumLine(x.z() - kStep)) / (2 * kStep);
  return std::abs(x.y() - SternumLine(x.z())) / std::hypot(1.0, slope) - half_thickness;
}

// Inside the lateral borders.
double BetweenBorders(const Eigen::Vector3d& x) {
  constexpr double kStep = 0.5;
  const double slope = (SternumHalfWidth(x.z() + kStep) - SternumHalfWidth(x.z() - kStep)) / (2 * kStep);
  return (x.x() - SternumHalfWidth(x.z())) / std::hypot(1.0, slope);
}

// Outside of the costal notches, in which the cartilages end.
double OutsideCostalNotches(const Eigen::Vector3d& x) {
  constexpr double kRadius = 5.6, kOutside = 3.2;
  double outside = -2 * kRadius;
  for (int number = 1; number <= kCostalNotches; ++number) {
    const double z = SternalNotch(number);
    outside = std::max(outside, kRadius - std::hypot(x.x() - SternumHalfWidth(z) - kOutside, x.z() - z));
  }
  return outside;
}

// Below the upper border of the manubrium: the jugular notch, and the clavicular notches that face up and outwards.
double BelowUpperBorder(const Eigen::Vector3d& x) {
  const double below = x.z() - (kNotch + 3.5);
  const double jugular = 15 - std::hypot(0.85 * x.x(), x.z() - (kNotch + 14.5));
  const double clavicular = 14 - std::hypot(x.x() - 29, x.z() - (kNotch + 11));
  return SmoothMax(SmoothMax(below, jugular, 3), clavicular, 3);
}

Mesh Plate(const Field& half, double bottom, double top, double edge_length) {
  constexpr double kDetail = 2.2, kMargin = 5;
  const Field field = [&half](const Eigen::Vector3d& x) { return half({std::abs(x.x()), x.y(), x.z()}); };
  const auto [front, back] = std::minmax({SternumLine(bottom), SternumLine(top), SternumLine((bottom + top) / 2)});
  const Box box{{-38, front - 15, bottom - kMargin}, {38, back + 15, top + kMargin}};
  return ImplicitSurface(field, box, edge_length, kDetail);
}

// Half the thickness of the body [mm], with faint transverse lines where its segments have fused.
double BodyHalfThickness(double z) {
  double half = 4.8;
  for (const double line : {241.0, 266.0, 292.0}) half += 0.5 * std::exp(-(z - line) * (z - line) / 9);
  return half;
}

}  // namespace

double SternumHalfWidth(double z) {
  if (z > kAngle) {  // manubrium: 13 mm at the angle, 30 mm below the clavicular notches, narrower at the top
    const double up = std::min(1.0, (z - kAngle) / (kNotch - kAngle));
    return 13 + 17 * Smooth(up / 0.75) - 8 * Smooth((up - 0.78) / 0.22);
  }
  if (z > kBodyEnd) {  // body: widest a third from its lower end
    const double up = (z - kBodyEnd) / (kAngle - kBodyEnd);
    return 10 + 3 * Smooth(up / 0.1) + 40 * up * (1 - up) * (1 - up) + 0.5 * up;
  }
  const double down = std::min(1.0, (kBodyEnd - z) / (kBodyEnd - kXiphoidTip));
  return 9.8 - 6.8 * std::pow(down, 1.7);
}

double SternalNotch(int number) { return 342 - 25.5 * (number - 1) + 0.85 * (number - 1) * (number - 1); }

Mesh Manubrium(double edge_length) {
  constexpr double kMaxEdge = 7, kBottom = kAngle;
  const Field half = [](const Eigen::Vector3d& x) {
    const double outline = SmoothMax(BelowUpperBorder(x), SmoothMax(BetweenBorders(x), OutsideCostalNotches(x), 2), 4);
    return SmoothMax(SmoothMax(outline, kBottom - x.z(), 0.8), BetweenFaces(x, 5.8), kRounded);
  };
  return Plate(half, kBottom, kNotch + 5, std::min(edge_length, kMaxEdge));
}

Mesh SternumBody(double edge_length) {
  constexpr double kMaxEdge = 7, kBottom = kBodyEnd, kTop = kAngle;
  const Field half = [](const Eigen::Vector3d& x) {
    const double outline = SmoothMax(BetweenBorders(x), OutsideCostalNotches(x), 2);
    const double ends = std::max(kBottom - x.z(), x.z() - kTop);
    return SmoothMax(SmoothMax(outline, ends, 0.8), BetweenFaces(x, BodyHalfThickness(x.z())), kRounded);
  };
  return Plate(half, kBottom, kTop, std::min(edge_length, kMaxEdge));
}

Mesh Xiphoid(double edge_length) {
  constexpr double kMaxEdge = 5, kTop = kBodyEnd + kOverlap;
  const Field half = [](const Eigen::Vector3d& x) {
    const double down = std::clamp((kTop - x.z()) / (kTop - kXiphoidTip), 0.0, 1.0);
    const double tip = std::hypot(x.x(), std::max(0.0, kXiphoidTip + 3 - x.z())) - 3.2;  // rounds the lower end
    const double outline = x.z() < kXiphoidTip + 3 ? tip : BetweenBorders(x);
    return SmoothMax(SmoothMax(outline, x.z() - kTop, 0.8), BetweenFaces(x, 3.6 - 1.8 * down), 3.5);
  };
  return Plate(half, kXiphoidTip, kTop, std::min(edge_length, kMaxEdge));
}

}  // namespace phrenic::anatomy
