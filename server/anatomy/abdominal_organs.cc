#include "server/anatomy/abdominal_organs.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "server/anatomy/implicit_surface.h"
#include "server/anatomy/spaces.h"
#include "server/anatomy/vessels.h"

namespace phrenic::anatomy {
namespace {

constexpr double kBelowSheet = 4.5, kFromStomach = 2, kCoarsestOrgan = 10, kOrganDetail = 5;  // [mm]
constexpr double kOrganFar =
    8;  // beyond this distance from one of the shapes that an organ is cut from, no other counts

double SoftPlus(double t) { return std::log1p(std::exp(t)); }

// The fields below are approximate signed distances [mm], negative inside.

double StomachShape(const Eigen::Vector3d& x) {
  static const Eigen::Vector3d cardia = OesophagusEnd();
  const Eigen::Vector3d fundus(56, 14, 170), body(50, -22, 118), antrum(12, -46, 92), pylorus(-20, -36, 98);
  double field = Ellipsoid(x, fundus, {34, 34, 33});
  field = SmoothMin(field, Capsule(x, fundus, body, 31, 27), 12);
  field = SmoothMin(field, Capsule(x, body, antrum, 27, 19), 12);
  field = SmoothMin(field, Capsule(x, antrum, pylorus, 18, 11), 10);
  return SmoothMin(field, Capsule(x, cardia, fundus, 8, 16), 8);
}

// Returns what is left of a shape below the diaphragm.
double UnderSheet(double shape, const Eigen::Vector3d& x) {
  return shape > kOrganFar ? shape : SmoothMax(shape, BelowDiaphragm(x, kBelowSheet), 8);
}

// Returns what is left of a shape beside the stomach.
double BesideStomach(double shape, const Eigen::Vector3d& x) {
  return shape > kOrganFar ? shape : SmoothMax(shape, kFromStomach - StomachShape(x), 6);
}

// Above the visceral surface, which rises to the left and backwards.
double AboveVisceralSurface(const Eigen::Vector3d& x) {
  const double lowest = 78 + 38 * SoftPlus((x.x() + 50) / 45) + 0.45 * (x.y() + 30);
  return (lowest - x.z()) / 1.35;
}

double LiverField(const Eigen::Vector3d& x) {
  const double behind = x.y() - 12 - 1.3 * SoftPlus((-22 - x.x()) / 5) * 5;  // the bare area is on the right
  const double shape = SmoothMax(SmoothMax(AboveVisceralSurface(x), x.x() - 70, 14), behind / 1.3, 16);
  return UnderSheet(BesideStomach(shape, x), x);
}

double SpleenField(const Eigen::Vector3d& x) {
  static const Eigen::AngleAxisd along_rib(-0.5, Eigen::Vector3d::UnitX());
  const Eigen::Vector3d centre(86, 44, 138);
  const double shape = Ellipsoid(along_rib * (x - centre), Eigen::Vector3d::Zero(), {28, 49, 35});
  return UnderSheet(BesideStomach(shape, x), x);
}

}  // namespace

Mesh Liver(double edge_length) {
  return ImplicitSurface(LiverField, {{-130, -95, 60}, {80, 105, 232}}, std::min(edge_length, kCoarsestOrgan),
                         kOrganDetail);
}

Mesh Stomach(double edge_length) {
  const Field field = [](const Eigen::Vector3d& x) { return UnderSheet(StomachShape(x), x); };
  return ImplicitSurface(field, {{-40, -85, 65}, {105, 65, 212}}, std::min(edge_length, kCoarsestOrgan), kOrganDetail);
}

Mesh Spleen(double edge_length) {
  return ImplicitSurface(SpleenField, {{45, -15, 80}, {125, 100, 195}}, std::min(edge_length, kCoarsestOrgan),
                         kOrganDetail);
}

}  // namespace phrenic::anatomy
