#include "server/anatomy/dimensions.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace phrenic::anatomy {
namespace {

// Half the width of the cage [mm]: widest at the eighth rib, closing elliptically above the lungs' apices.
double HalfWidth(double z) {
  constexpr double kWidest = 185, kLargest = 131, kAbove = 216, kBelow = 270;
  const double away = z > kWidest ? (z - kWidest) / kAbove : (kWidest - z) / kBelow;
  return kLargest * std::sqrt(std::max(0.015, 1 - away * away));
}

// y of the back of the cage beside the spine [mm]: most posterior at the sixth and seventh ribs.
double Back(double z) {
  const double away = z > 235 ? (z - 235) / 150 : (235 - z) / 150;
  return 107 - (z > 235 ? 50 : 20) * away * away;
}

// y of the front of the cage [mm]: behind the sternum, vertical below it, with a smooth bend at the xiphoid.
double Front(double z) {
  constexpr double kSoft = 12;
  const double bend = kSoft * std::log1p(std::exp((z - 205) / kSoft));
  return -98 + 0.5 * bend;
}

}  // namespace

double SpineFront(double z) { return 20 + 25 * std::cos(std::numbers::pi * (z - 290) / 290); }

double SpineSlope(double z) { return -25 * std::numbers::pi / 290 * std::sin(std::numbers::pi * (z - 290) / 290); }

VertebralBody BodyOfVertebra(int number) {
  VertebralBody body{};
  double z = 0;
  for (int n = kVertebrae; n >= number; --n) {
    const double up = static_cast<double>(kVertebrae - n) / (kVertebrae - 1);  // from 0 at L3 to 1 at T1
    const double height = 28 - 12 * up;
    body.bottom = z;
    body.top = z + height;
    body.width = 46 - 17 * std::sqrt(up) + 3 * std::max(0.0, up - 0.75) * 4;
    body.depth = 34 - 15 * up;
    z = body.top + 3 + 5 * (1 - up) * (1 - up);
  }
  return body;
}

CageSection::CageSection(double z, double inset)
    : half_width_(HalfWidth(z) - inset),
      half_depth_((Back(z) - Front(z)) / 2 - inset),
      centre_((Back(z) + Front(z)) / 2),
      column_(centre_ + half_depth_ - (SpineFront(z) - inset / 2)) {}

namespace {

constexpr double kCageSquareness = 0.3;  // 0 gives an ellipse
constexpr double kColumnHalfWidth = 33;  // of the vertebral column with the paraspinal muscles [mm]

// Relative depth of the vertebral column's impression at x [mm].
double Pressed(double x) { return 1 / (1 + std::pow(x / kColumnHalfWidth, 4)); }

}  // namespace

Eigen::Vector2d CageSection::Point(const Eigen::Vector2d& q) const {
  const double x = half_width_ * q.x();
  const double y = centre_ + half_depth_ * q.y() * (1 + kCageSquareness * q.x() * q.x());
  return {x, y - column_ * Pressed(x) * (1 + q.y()) / 2};
}

Eigen::Vector2d CageSection::DiscCoordinates(const Eigen::Vector2d& point) const {
  const double across = point.x() / half_width_, pressed = column_ * Pressed(point.x()) / 2;
  const double slope = half_depth_ * (1 + kCageSquareness * across * across) - pressed;
  return {across, (point.y() - centre_ + pressed) / slope};
}

double SternumLine(double z) {
  constexpr double kSoft = 5;  // width of the xiphoid's posterior bend [mm]
  return -99 + 0.62 * kSoft * std::log1p(std::exp((z - 210) / kSoft)) - 0.12 * (z - 210);
}

}  // namespace phrenic::anatomy
