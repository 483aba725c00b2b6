// A person's shape: one smooth map of space from the generated adult to a person, for every structure alike. What does
// not touch in the adult does not touch in the person, since the map is one to one for every physique within its
// ranges: its Jacobian determinant, without the scales, is above 0.15 in the thorax (tests/anatomy/physique_test.cc).
//
// In this order, in the adult's frame of dimensions.h [mm]:
//
//   domes      z += (h_right w_right + h_left w_left) (1 - q^4)^2 s(z), q the distance from the middle of the cage's
//              section (1 at its inner face), s(z) 1 at the domes and 0 at their rim and at the lungs' apices
//   ribs       z -= m r, r the distance in front of the spine, m = tan(31 + slope) - tan 31 degrees
//   kyphosis   y += d w, z -= d' L tanh((y - y_spine)/L): the spine's curve is d(z) = D sin^2(pi t), t from 0 at T12 to
//              1 at T1, which is steepest by half of the angle; what is beside it is carried perpendicular to it
//   twist      y -= tan(a) x, x += tan(a) L tanh((y - y_spine)/L), a(z) = a_0 sin^2(pi t), a_0 a quarter of the Cobb
//              angle: the vertebrae turn, the breastbone stays in front
//   scoliosis  x -= c w, z += c' w L tanh(x/L), c(z) = A sin^2(pi t): the end vertebrae, T3 and T11, are inclined by
//              half of the Cobb angle
//   size       height, and the chest's width and depth
//
// w falls from 1 at the spine to 0.3 at the breastbone. L = 60 mm: far from the spine ribs crowd no further.
// Sources: rotation and hump of thoracic scoliosis grow with the Cobb angle, the vertebrae turn to the convex side
// (Stokes, Spine 1994;19:236). The shares 0.3 and a quarter are chosen.
#ifndef PHRENIC_SERVER_ANATOMY_PHYSIQUE_H_
#define PHRENIC_SERVER_ANATOMY_PHYSIQUE_H_

#include <Eigen/Core>

#include "phrenic/v1/scene.pb.h"

namespace phrenic::anatomy {

// Immutable, thread-safe.
class PhysiqueMap {
 public:
  explicit PhysiqueMap(const v1::Physique& physique);

  // Maps a point of the adult to the person [mm].
  Eigen::Vector3d operator()(const Eigen::Vector3d& adult) const;

  // True if it maps every point to itself.
  bool IsIdentity() const { return identity_; }

 private:
  void RaiseDomes(Eigen::Vector3d& x) const;
  void BendBack(Eigen::Vector3d& x) const;
  void BendAside(Eigen::Vector3d& x) const;

  bool identity_ = true;
  Eigen::Vector3d scale_ = Eigen::Vector3d::Ones();
  double right_dome_ = 0, left_dome_ = 0;  // [mm]
  double rib_slope_ = 0;                   // m
  double kyphosis_ = 0, scoliosis_ = 0;    // tangents of half the angles
  double twist_ = 0;                       // tan(a) at the apex
};

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_PHYSIQUE_H_
