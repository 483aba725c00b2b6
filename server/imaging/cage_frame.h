// A patient-specific polar frame in which the sheet between thorax and abdomen is a depth function.
//
// A plane point p (+x left, +y posterior) maps to a ray. For |p| <= 1 it starts at the centre, at an angle of |p| 90
// degrees from +z towards the azimuth of p. For |p| > 1 it is horizontal and starts (|p| - 1) wall_length below the
// centre. Rays reach the domes from below and the wall from inside the cage, and the sheet is one smooth depth r(p)
// along them, without a pole.
#ifndef PHRENIC_SERVER_IMAGING_CAGE_FRAME_H_
#define PHRENIC_SERVER_IMAGING_CAGE_FRAME_H_

#include <vector>

#include "absl/status/statusor.h"
#include "server/imaging/segmented_parts.h"

namespace phrenic::imaging {

inline constexpr double kPlaneReach = 1.8;  // maximum |p|

struct Ray {
  Eigen::Vector3d origin, direction;  // [mm]; direction is a unit vector
  Eigen::Vector3d At(double depth) const { return origin + depth * direction; }
};

// Lengths in millimetres, in the volume's LPS frame.
struct CageFrame {
  Eigen::Vector3d centre;
  double wall_length = 0;
  double width = 0;              // of the cage
  double sternum_end = 0;        // z of the sternum's lower end
  double lumbar[3] = {0, 0, 0};  // z of the centres of L1, L2, L3
  double vertebra_height = 0;    // distance between the centres of neighbouring vertebrae
  double spine_front = 0;        // y of the anterior face of the spine at T12
  double top = 0;                // z of the upper end of the cage: of T1, else of the lungs
  double top_centre = 0;         // y midway between sternum and spine there

  Ray RayOf(const Eigen::Vector2d& p) const;
  // Returns the plane point of the ray through a point.
  Eigen::Vector2d PlaneOf(const Eigen::Vector3d& point) const;
  // Returns (x, y) of the axis of horizontal rays at a height: vertical up to the sternum's lower end, and from there
  // straight to `top_centre`, as the cage leans back.
  Eigen::Vector2d Axis(double z) const;
  // Returns the lower end of L1, below which the crura are fixed to the vertebrae.
  double CrusFixedBelow() const { return lumbar[0] - vertebra_height / 2; }
};

// Fits the frame to the segmented parts. Replaces a missing landmark by a typical value and adds a message to
// `fallbacks`. FAILED_PRECONDITION if there are neither ribs 6-12 nor lungs, or no vertebra, or if their
// proportions are not those of a person, or left and right, or front and back are exchanged.
absl::StatusOr<CageFrame> FindCageFrame(const LabelVolume& volume, const std::vector<Part>& parts,
                                        Fallbacks& fallbacks);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_CAGE_FRAME_H_
