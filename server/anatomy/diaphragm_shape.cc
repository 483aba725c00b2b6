#include "server/anatomy/diaphragm_shape.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "server/anatomy/dimensions.h"

namespace phrenic::anatomy {
namespace {

constexpr double kFoldAt = 1.3;      // d at the fold between dome and wall
constexpr double kSquareness = 2.6;  // m; the meridian is a superellipse of degree 2 m

double Bump(const Eigen::Vector2d& q, double x, double y, double wide, double deep) {
  const double u = (q.x() - x) / wide, v = (q.y() - y) / deep;
  return std::exp(-u * u - v * v);
}

// Height of the domes, without the bend down at the margin [mm].
double Top(const Eigen::Vector2d& q) {
  return 194 + 30 * Bump(q, -0.5, 0.05, 0.48, 0.65) + 13.5 * Bump(q, 0.55, 0.15, 0.42, 0.55) +
         10 * Bump(q, 0.05, -0.4, 0.6, 0.5);
}

// Height at which the sheet leaves the chest wall, by azimuth [mm]; lower on the left, like the dome.
double Fold(const Eigen::Vector2d& azimuth) {
  const double c = -azimuth.y(), s = azimuth.x();
  const double c2 = 2 * c * c - 1, c3 = c * (4 * c * c - 3);
  return 135 + 19.5 * c + 29 * c2 - 4 * c3 - 4 * s;
}

Eigen::Vector2d Azimuth(const Eigen::Vector2d& p) {
  const double d = p.norm();
  return d > 1e-9 ? Eigen::Vector2d(p / d) : Eigen::Vector2d(0, -1);
}

double Rho(double d) { return d < kFoldAt ? d - 0.1365 * d * d * d : 1.0001055 + 0.307955 * (d - kFoldAt); }

struct Meridian {
  Eigen::Vector2d q;
  double z;
};

Meridian OnMeridian(const Eigen::Vector2d& p) {
  const Eigen::Vector2d azimuth = Azimuth(p);
  const double rho = Rho(p.norm()), fold = Fold(azimuth);
  if (rho >= 1) return {azimuth, fold - kSquareness * std::numbers::pi / 2 * (Top(azimuth) - fold) * (rho - 1)};
  const double phi = std::numbers::pi / 2 * std::pow(rho, kSquareness);
  const Eigen::Vector2d q = std::pow(std::sin(phi), 1 / kSquareness) * azimuth;
  return {q, fold + (Top(q) - fold) * std::cos(phi)};
}

// Returns the plane point of the meridian at height z, by bisection; height decreases along it beyond d = 0.8.
Eigen::Vector2d AtHeight(const Eigen::Vector2d& azimuth, double z) {
  double low = 0.8, high = 12;
  for (int i = 0; i < 50; ++i) {
    const double middle = (low + high) / 2;
    (OnMeridian(azimuth * middle).z > z ? low : high) = middle;
  }
  return azimuth * low;
}

// A control point of the rim: azimuth from the front [degrees] and height [mm].
struct RimKnot {
  double degrees, z;
};

// The costal and lumbar border of one side, from the xiphoid back to the medial arcuate ligament.
constexpr RimKnot kBorder[] = {{5, 189},  {12, 183}, {21, 164}, {30, 140}, {39, 118}, {48, 103},
                               {58, 88},  {70, 69},  {85, 52},  {100, 45}, {115, 43}, {128, 44},
                               {138, 54}, {147, 72}, {154, 86}, {160, 91}, {165, 88}};

// The crura, from the lateral edge around the tip to the medial edge.
constexpr RimKnot kRightCrus[] = {{167, 76},   {168.5, 58}, {170, 40}, {171.5, 31}, {173, 16},
                                  {174.5, 18}, {175.5, 33}, {176, 60}, {176.2, 90}, {177.5, 116}};
constexpr RimKnot kLeftCrus[] = {{167, 78},   {168.5, 68}, {170, 58}, {171.5, 53}, {173, 43},
                                 {174.5, 45}, {175.5, 57}, {176, 72}, {176.2, 94}, {177.5, 116}};

Eigen::Vector2d Spline(const std::vector<Eigen::Vector2d>& knots, size_t span, double t) {
  const size_t n = knots.size();
  const double u = 1 - t;
  return (u * u * u * knots[(span + n - 1) % n] + (3 * t * t * t - 6 * t * t + 4) * knots[span] +
          (3 * u * u * u - 6 * u * u + 4) * knots[(span + 1) % n] + t * t * t * knots[(span + 2) % n]) /
         6;
}

// Returns the control points around the rim: azimuth from the front, positive to the left, unwrapped to [0, 360)
// degrees, and height [mm].
std::vector<Eigen::Vector2d> RimKnots() {
  std::vector<Eigen::Vector2d> knots;
  for (const RimKnot& knot : kBorder) knots.emplace_back(knot.degrees, knot.z);
  for (const RimKnot& knot : kLeftCrus) knots.emplace_back(knot.degrees, knot.z);
  knots.emplace_back(180, 124);  // the median arcuate ligament over the aorta
  for (auto knot = std::rbegin(kRightCrus); knot != std::rend(kRightCrus); ++knot) {
    knots.emplace_back(360 - knot->degrees, knot->z);
  }
  for (auto knot = std::rbegin(kBorder); knot != std::rend(kBorder); ++knot) {
    knots.emplace_back(360 - knot->degrees, knot->z);
  }
  return knots;
}

// Returns an ellipse in the sheet's tangent plane, semi-axes `across` and `along` [mm], mapped to the parameter plane.
PlaneLoop Opening(const Eigen::Vector2d& centre, double across, double along) {
  constexpr double kStep = 1e-4;
  constexpr int kSamples = 120;
  const Eigen::Vector2d ex(kStep, 0), ey(0, kStep);
  Eigen::Matrix<double, 3, 2> jacobian;
  jacobian.col(0) = (DiaphragmPoint(centre + ex) - DiaphragmPoint(centre - ex)) / (2 * kStep);
  jacobian.col(1) = (DiaphragmPoint(centre + ey) - DiaphragmPoint(centre - ey)) / (2 * kStep);
  const Eigen::Vector3d normal = DiaphragmNormal(centre);
  const Eigen::Vector3d second = normal.cross(Eigen::Vector3d::UnitX()).normalized();
  const Eigen::Vector3d first = second.cross(normal);
  Eigen::Matrix2d local;
  local.row(0) = first.transpose() * jacobian;
  local.row(1) = second.transpose() * jacobian;
  const Eigen::Matrix2d to_plane = local.inverse();
  PlaneLoop loop;
  for (int i = 0; i < kSamples; ++i) {
    const double angle = 2 * std::numbers::pi * i / kSamples;
    loop.push_back(centre + to_plane * Eigen::Vector2d(across * std::cos(angle), along * std::sin(angle)));
  }
  return loop;
}

// Returns the distance of q from the segment a b.
double ToSegment(const Eigen::Vector2d& q, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const double t = std::clamp((q - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (q - a - t * (b - a)).norm();
}

}  // namespace

Eigen::Vector3d DiaphragmPoint(const Eigen::Vector2d& p) {
  const Meridian at = OnMeridian(p);
  const Eigen::Vector2d xy = CageSection(at.z, kDiaphragmInset).Point(at.q);
  return {xy.x(), xy.y(), at.z};
}

Eigen::Vector3d DiaphragmNormal(const Eigen::Vector2d& p) {
  constexpr double kStep = 1e-3;
  const Eigen::Vector2d ex(kStep, 0), ey(0, kStep);
  const Eigen::Vector3d along_x = DiaphragmPoint(p + ex) - DiaphragmPoint(p - ex);
  const Eigen::Vector3d along_y = DiaphragmPoint(p + ey) - DiaphragmPoint(p - ey);
  return along_x.cross(along_y).normalized();
}

double DomeHeight(const Eigen::Vector2d& q) {
  const double r = std::min(1.0, q.norm()), fold = Fold(Azimuth(q));
  return fold + (Top(q) - fold) * std::sqrt(1 - std::pow(r, 2 * kSquareness));
}

PlaneLoop DiaphragmRim() {
  constexpr int kSamplesASpan = 40;
  const std::vector<Eigen::Vector2d> knots = RimKnots();
  PlaneLoop rim;
  for (size_t span = 0; span < knots.size(); ++span) {
    std::vector<Eigen::Vector2d> around = knots;
    for (Eigen::Vector2d& knot : around) {  // unwrap about the span's own knot
      knot.x() += 360 * std::round((knots[span].x() - knot.x()) / 360);
    }
    for (int i = 0; i < kSamplesASpan; ++i) {
      const Eigen::Vector2d at = Spline(around, span, static_cast<double>(i) / kSamplesASpan);
      const double angle = at.x() * std::numbers::pi / 180;
      rim.push_back(AtHeight({std::sin(angle), -std::cos(angle)}, at.y()));
    }
  }
  return rim;
}

PlaneLoop CavalOpening() { return Opening({-0.24, 0.12}, 13, 12); }

PlaneLoop OesophagealOpening() { return Opening({0.09, 1.06}, 8, 11); }

double OutsideLeaves(const Eigen::Vector2d& q) {
  const Eigen::Vector2d front(0.02, -0.4), middle(-0.02, -0.1), right(-0.52, 0.2), left(0.56, 0.24);
  return std::min({ToSegment(q, middle, front) - 0.4, ToSegment(q, Eigen::Vector2d(-0.15, 0), right) - 0.36,
                   ToSegment(q, Eigen::Vector2d(0.12, -0.05), left) - 0.31});
}

bool InTendon(const Eigen::Vector2d& p) { return p.norm() <= kFoldAt && OutsideLeaves(OnMeridian(p).q) < 0; }

bool InRightCrus(const Eigen::Vector2d& p) {
  const Eigen::Vector3d x = DiaphragmPoint(p);
  return p.y() > kFoldAt && x.x() < 0 && x.x() > -30 && x.z() < 100;
}

bool InLeftCrus(const Eigen::Vector2d& p) {
  const Eigen::Vector3d x = DiaphragmPoint(p);
  return p.y() > kFoldAt && x.x() > 0 && x.x() < 30 && x.z() < 100;
}

}  // namespace phrenic::anatomy
