// A patient's own polar frame for the sheet between thorax and abdomen.
//
// A point p of the plane stands for a ray: at |p| <= 1 from the centre, turned by |p| 90 degrees from upwards towards
// the azimuth of p (p.x to the left, p.y to the back); beyond, horizontally, from |p| - 1 wall lengths below the
// centre. So the domes are seen from below and the wall from the middle of the cage, and the sheet is a depth r(p)
// along the rays, one smooth function without a pole.
#ifndef PHRENIC_SERVER_IMAGING_CAGE_FRAME_H_
#define PHRENIC_SERVER_IMAGING_CAGE_FRAME_H_

#include <vector>

#include "absl/status/statusor.h"
#include "server/imaging/parts.h"

namespace phrenic::imaging {

inline constexpr double kPlaneReach = 1.8;  // rays are asked for up to this |p|

struct Ray {
  Eigen::Vector3d origin, direction;  // [mm]; unit
  Eigen::Vector3d At(double depth) const { return origin + depth * direction; }
};

// Lengths in millimetres, LPS.
struct CageFrame {
  Eigen::Vector3d centre;
  double wall_length = 0;
  double width = 0;              // of the cage
  double sternum_end = 0;        // z of the sternum's lower end
  double lumbar[3] = {0, 0, 0};  // z of the middle of L1, L2, L3
  double vertebra_height = 0;    // from one middle to the next
  double spine_front = 0;        // y, of L1

  Ray RayOf(const Eigen::Vector2d& p) const;
};

// Where the parts say too little, what is usual beside the rest is taken, and a sentence added. FAILED_PRECONDITION
// where there are neither ribs nor lungs, or no vertebra.
absl::StatusOr<CageFrame> FindCageFrame(const LabelVolume& volume, const std::vector<Part>& parts,
                                        Sentences& fallbacks);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_CAGE_FRAME_H_
