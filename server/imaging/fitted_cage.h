// The inner face of a person's rib cage, smooth: the surface on which the diaphragm lies and slides in its zone of
// apposition.
#ifndef PHRENIC_SERVER_IMAGING_FITTED_CAGE_H_
#define PHRENIC_SERVER_IMAGING_FITTED_CAGE_H_

#include "server/imaging/cage_frame.h"
#include "server/imaging/thin_plate.h"
#include "server/mesh/mesh.h"

namespace phrenic::imaging {

// A radius R(azimuth, z) about the frame's axis (CageFrame::Axis), from the lower end of L3 to the top of the cage,
// on a grid of 144 azimuths and heights 4 mm apart. Horizontal rays find the first voxel of rib, cartilage, sternum or
// vertebra; R is the thin plate that stays 3.5 mm inside of them: in ten rounds of reweighting, a bone that is nearer
// to the axis than the plate has 33 times the weight of one further out, so that R passes under the ribs and bridges
// the spaces between them. If the diaphragm is labelled, a second fit adds its middle where it is at most 15 mm inside
// of the first one, with no lung between: there it lies on the wall. Lengths in millimetres, frame LPS. Immutable,
// thread-safe.
class FittedCage {
 public:
  // Adds a message to `fallbacks` with the share of directions without a bone, and how near to the wall bones are.
  FittedCage(const LabelVolume& volume, const std::vector<Part>& parts, const CageFrame& frame, Fallbacks& fallbacks);

  // Returns R at an azimuth from the front (-y) towards the left (+x) [rad]; a cubic B-spline (C2). Below and above the
  // grid it is that of its border.
  double Radius(double azimuth, double z) const;
  // Returns the point moved along its radius: onto the wall if it is outside of it or at most 1 mm inside, and by ever
  // less further in, up to 5 mm. Elsewhere the point itself.
  Eigen::Vector3d Inside(const Eigen::Vector3d& point) const;
  // Returns how far outside of the wall Inside moves a point, by how far it was [mm]; both are negative inside.
  static double DrawnGap(double gap);
  // Returns the point, moved along its radius if it is outside of the wall: by ever less than `outside` [mm], so that
  // points keep their order.
  Eigen::Vector3d Within(const Eigen::Vector3d& point, double outside) const;
  // Returns the disc coordinates of a point, as anatomy::CageSection: x and y within the width and the depth of the
  // wall at its height, from -1 to 1.
  Eigen::Vector2d DiscCoordinates(const Eigen::Vector3d& point) const;
  // True if the point is on the wall, to a millimetre.
  bool OnWall(const Eigen::Vector3d& point) const;
  // Returns the wall as a tube, open below and above: a grid like anatomy::InnerCage, triangles facing outwards.
  Mesh Tube() const;

 private:
  struct Polar {
    Eigen::Vector2d axis;
    double azimuth, radius;
  };
  Polar PolarOf(const Eigen::Vector3d& point) const;

  CageFrame frame_;
  PlateGrid grid_;
  double bottom_ = 0;  // z of row 0
  Eigen::VectorXd radius_;
};

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_FITTED_CAGE_H_
