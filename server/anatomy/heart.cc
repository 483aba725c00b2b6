#include "server/anatomy/heart.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "server/anatomy/meshing/implicit_surface.h"
#include "server/anatomy/spaces.h"

namespace phrenic::anatomy {
namespace {

// The fields below are approximate signed distances [mm], negative inside.

// The left ventricle, whose apex points forwards, down and to the left.
double LeftVentricle(const Eigen::Vector3d& x) {
  static const Eigen::Quaterniond upright =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d(0.72, -0.45, -0.53), Eigen::Vector3d::UnitX());
  return Ellipsoid(upright * (x - Eigen::Vector3d(18, -36, 238)), Eigen::Vector3d::Zero(), {59, 41, 41});
}

double Chambers(const Eigen::Vector3d& x) {
  const double right_ventricle = Ellipsoid(x, {2, -44, 238}, {38, 31, 41});
  const double right_atrium = Ellipsoid(x, {-20, -14, 244}, {22, 26, 35});
  const double left_atrium = Ellipsoid(x, {0, 2, 262}, {30, 17, 20});
  return SmoothMin(SmoothMin(LeftVentricle(x), right_ventricle, 9), SmoothMin(right_atrium, left_atrium, 9), 9);
}

double PulmonaryTrunk(const Eigen::Vector3d& x) {
  const Eigen::Vector3d root(10, -50, 258), fork(13, -26, 301);
  const double branches = SmoothMin(Capsule(x, fork, {36, 2, 301}, 9, 7.5), Capsule(x, fork, {-36, 6, 295}, 9, 7.5), 4);
  return SmoothMin(Capsule(x, root, fork, 12, 11), branches, 5);
}

}  // namespace

Mesh Heart(double edge_length) {
  constexpr double kAboveSheet = 3.5, kMaxEdge = 9, kDetail = 4, kFar = 8;
  const Field field = [](const Eigen::Vector3d& x) {
    const double trunk = PulmonaryTrunk(x);
    double chambers = Chambers(x);
    if (chambers < kFar) chambers = SmoothMax(chambers, BetweenLungs(x, kAboveSheet), 8);  // saves time elsewhere
    return SmoothMin(chambers, trunk, 7);
  };
  return ImplicitSurface(field, {{-60, -95, 185}, {75, 35, 318}}, std::min(edge_length, kMaxEdge), kDetail);
}

}  // namespace phrenic::anatomy
