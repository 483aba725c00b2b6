#include "server/anatomy/abdominal_organs.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "server/anatomy/meshing/implicit_surface.h"
#include "server/anatomy/meshing/tube.h"
#include "server/anatomy/spaces.h"
#include "server/anatomy/vessels.h"

namespace phrenic::anatomy {
namespace {

constexpr double kBelowSheet = 4.5, kFromStomach = 2, kFromSpleen = 2, kCoarsestOrgan = 10, kOrganDetail = 5;  // [mm]
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
double UnderSheet(double shape, const Eigen::Vector3d& x, double gap = kBelowSheet) {
  return shape > kOrganFar ? shape : SmoothMax(shape, BelowDiaphragm(x, gap), 8);
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

// A bean of 114 x 60 x 44 mm, `centre` on the left side: its hilum faces forwards and to the spine, its upper pole is
// nearer to the spine and further back.
double KidneyShape(const Eigen::Vector3d& x, const Eigen::Vector3d& centre) {
  static const Eigen::Quaterniond upright = Eigen::AngleAxisd(0.45, Eigen::Vector3d::UnitZ()) *
                                            Eigen::AngleAxisd(0.17, Eigen::Vector3d::UnitY()) *
                                            Eigen::AngleAxisd(-0.12, Eigen::Vector3d::UnitX());
  const Eigen::Vector3d p = upright * (x - centre);
  const double hilum = 22 - (p - Eigen::Vector3d(-43, 0, 0)).cwiseProduct(Eigen::Vector3d(1, 0.8, 0.8)).norm();
  return SmoothMax(Ellipsoid(p, Eigen::Vector3d::Zero(), {30, 22, 57}), hilum, 9);
}

constexpr double kKidneyBelowSheet = 7;  // room for the sheet, which bulges backwards in a breath [mm]

Mesh Kidney(const Field& field, double low, double edge_length) {
  return ImplicitSurface(field, {{15, -15, low}, {110, 85, low + 135}}, std::min(edge_length, kCoarsestOrgan),
                         kOrganDetail);
}

}  // namespace

Mesh LeftKidney(double edge_length) {
  const Field field = [](const Eigen::Vector3d& x) {
    const double shape = KidneyShape(x, {62, 32, 68});
    if (shape > kOrganFar) return shape;
    return UnderSheet(SmoothMax(shape, kFromSpleen - SpleenField(x), 5), x, kKidneyBelowSheet);
  };
  return Kidney(field, 0, edge_length);
}

Mesh RightKidney(double edge_length) {
  const Field field = [](const Eigen::Vector3d& x) {
    return UnderSheet(KidneyShape(x, {62, 32, 55}), x, kKidneyBelowSheet);
  };
  return Mirrored(Kidney(field, -13, edge_length));
}

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
