#include "server/anatomy/shoulder_girdle.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "server/anatomy/meshing/implicit_surface.h"
#include "server/anatomy/meshing/smooth.h"
#include "server/anatomy/meshing/tube.h"

namespace phrenic::anatomy {
namespace {

// The frame of the left scapula: its origin is where the spine of the scapula begins at the medial border; u points to
// the glenoid cavity, v upwards, w backwards and outwards [mm].
constexpr double kPlaneAngle = 34 * std::numbers::pi / 180;  // in front of the coronal plane
const Eigen::Vector3d kScapulaOrigin(60, 75, 345);

Eigen::Vector3d ToScapula(const Eigen::Vector3d& x) {
  const Eigen::Vector3d d = x - kScapulaOrigin;
  const double c = std::cos(kPlaneAngle), s = std::sin(kPlaneAngle);
  return {c * d.x() - s * d.y(), d.z(), s * d.x() + c * d.y()};
}

Eigen::Vector3d FromScapula(const Eigen::Vector3d& p) {
  const double c = std::cos(kPlaneAngle), s = std::sin(kPlaneAngle);
  return kScapulaOrigin + Eigen::Vector3d(c * p.x() + s * p.z(), -s * p.x() + c * p.z(), p.y());
}

// Returns w of the middle of the plate, which follows the chest wall: its top leans forwards.
double PlateAt(double u, double v) {
  const double down = -v / 100, bend = down > 0 ? -24.9 : 60;
  return 10 + 55.6 * down + bend * down * down - 8e-4 * (u - 15) * (u - 15);
}

// The outline of the plate in (u, v), anticlockwise: medial border, inferior angle, lateral border, glenoid cavity,
// superior border with its notch, superior angle.
const Eigen::Vector2d kScapulaOutline[] = {
    {2, 0},    {3, -30}, {6, -60}, {11, -88}, {16, -104}, {22, -110}, {30, -105}, {42, -84}, {58, -56}, {75, -31},
    {88, -13}, {94, 2},  {92, 18}, {78, 22},  {67, 17.5}, {56, 20.5}, {36, 33},   {18, 41},  {10, 39},  {5, 22}};

// Returns the signed distance to the outline, negative inside.
double OutsideOutline(const Eigen::Vector2d& p) {
  double nearest = 1e9;
  bool inside = false;
  const size_t count = std::size(kScapulaOutline);
  for (size_t i = 0; i < count; ++i) {
    const Eigen::Vector2d &a = kScapulaOutline[i], &b = kScapulaOutline[(i + 1) % count];
    const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
    nearest = std::min(nearest, (p - a - t * (b - a)).norm());
    const bool crosses = (a.y() > p.y()) != (b.y() > p.y());
    if (crosses && p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) inside = !inside;
  }
  return inside ? -nearest : nearest;
}

// Half the thickness of the plate [mm]: thick along the lateral border and at the neck.
double PlateHalfThickness(double u, double v) {
  const double to_border = (u - 94 - 0.72 * (v - 2)) / 1.23;
  const double pillar = 2.4 * std::exp(-(to_border + 5) * (to_border + 5) / 60) * Smooth((v + 110) / 40);
  const double neck = 4.5 * Smooth((u - 70) / 22) * std::exp(-(v - 4) * (v - 4) / 300);
  return 2.4 + pillar + neck;
}

double ScapulaPlate(const Eigen::Vector3d& p) {
  const double outline = OutsideOutline(p.head<2>());
  constexpr double kFar = 25;
  if (outline > kFar) return outline;
  const double across = 0.86 * std::abs(p.z() - PlateAt(p.x(), p.y())) - PlateHalfThickness(p.x(), p.y());
  return SmoothMax(outline, across, 2.5);
}

// The glenoid cavity: a pear-shaped rim with a shallow hollow for the head of the humerus.
double GlenoidRim(const Eigen::Vector3d& p) {
  const Eigen::Vector3d centre(95, 5, PlateAt(95, 5));
  return Ellipsoid(p, centre, {8, 19, 13});
}

double OutsideHumerus(const Eigen::Vector3d& p) {
  constexpr double kRadius = 36;
  return kRadius - (p - Eigen::Vector3d(99 + kRadius, 5, PlateAt(95, 5))).norm();
}

// Height of the crest of the spine above the plate, and v of the spine, along u.
double CrestHeight(double u) { return 2 + 0.33 * (u - 4); }
double SpineAt(double u) { return 1 + 0.27 * (u - 4); }

// The spine of the scapula: a fin on the plate with a rounded crest.
double ScapulaSpine(const Eigen::Vector3d& p) {
  constexpr double kFirst = 8, kLast = 84;
  const double u = std::clamp(p.x(), kFirst, kLast), v = SpineAt(u), plate = PlateAt(u, v);
  const double crest = plate + CrestHeight(u);
  const double beyond = std::max(0.0, std::abs(p.x() - u));
  const double above = std::max({0.0, p.z() - crest, plate - p.z()});
  return std::hypot(beyond, p.y() - v, above) - (2.3 + 0.9 * Smooth((p.z() - plate) / 24));
}

// The acromion, flat from above, which turns forwards over the joint.
double Acromion(const Eigen::Vector3d& p) {
  const double glenoid = PlateAt(95, 5);
  Eigen::Vector3d flat = p;
  constexpr double kFlat = 1.9;
  flat.y() *= kFlat;
  const auto at = [](double u, double v, double w) { return Eigen::Vector3d(u, kFlat * v, w); };
  const Eigen::Vector3d crest = at(82, SpineAt(82), PlateAt(82, SpineAt(82)) + CrestHeight(82));
  const Eigen::Vector3d angle = at(108, 31, glenoid + 28), middle = at(121, 34.5, glenoid + 10),
                        tip = at(119, 36, glenoid - 10);
  double field = SmoothMin(Capsule(flat, crest, angle, 5, 8), Capsule(flat, angle, middle, 8, 9.5), 4);
  field = SmoothMin(field, Capsule(flat, middle, tip, 9.5, 8), 4);
  return field / 1.4;
}

// The coracoid process: a finger that points forwards beside the glenoid cavity.
double Coracoid(const Eigen::Vector3d& p) {
  const double plate = PlateAt(84, 18);
  const Eigen::Vector3d root(83, 16, plate), bend(86, 25, plate - 12), tip(103, 15, plate - 42);
  return SmoothMin(Capsule(p, root, bend, 8, 7), Capsule(p, bend, tip, 6.6, 5), 4);
}

double ScapulaField(const Eigen::Vector3d& x) {
  const Eigen::Vector3d p = ToScapula(x);
  double field = SmoothMin(ScapulaPlate(p), GlenoidRim(p), 7);
  field = SmoothMax(field, OutsideHumerus(p), 2);
  field = SmoothMin(field, SmoothMin(ScapulaSpine(p), Acromion(p), 5), 5);
  return SmoothMin(field, Coracoid(p), 6);
}

}  // namespace

Mesh LeftClavicle(double edge_length) {
  const Curve path = {{30, -26, 368},  {48, -36, 369.5}, {74, -42, 372.5},          {100, -33, 376.5},
                      {122, -14, 380}, {134, 0, 382.5},  FromScapula({102, 38, -6})};
  const auto section = [](double s, const Eigen::Vector3d&) {
    const double sternal = 1 - Smooth(s / 0.28), acromial = Smooth((s - 0.55) / 0.4);
    return TubeSection{6.6 + 3.9 * sternal + 2.6 * acromial, 5.9 + 3.7 * sternal - 0.9 * acromial,
                       Eigen::Vector3d::UnitZ()};
  };
  return Tube({.through = path, .section = section}, edge_length);
}

Mesh LeftScapula(double edge_length) {
  constexpr double kMaxEdge = 6, kDetail = 2.5;
  const Box box{{50, -25, 225}, {190, 132, 396}};
  return ImplicitSurface(ScapulaField, box, std::min(edge_length, kMaxEdge), kDetail);
}

}  // namespace phrenic::anatomy
