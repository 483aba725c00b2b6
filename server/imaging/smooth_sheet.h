// The smoothest sheet through what was seen of it.
#ifndef PHRENIC_SERVER_IMAGING_SMOOTH_SHEET_H_
#define PHRENIC_SERVER_IMAGING_SMOOTH_SHEET_H_

#include <Eigen/Core>

#include "server/imaging/sheet_evidence.h"

namespace phrenic::imaging {

// A depth r(p) along the rays of a frame that is smooth everywhere: minimises sum w (r - seen)^2 + b sum (Laplacian
// r)^2 over the grid (a thin plate; Wahba, Spline Models, 1990), so that what was not seen goes on from around; seen
// depths that lie off lose weight over some rounds, w = 1 / (1 + (off / 6 mm)^2). Immutable; any thread.
class SmoothSheet {
 public:
  SmoothSheet(const CageFrame& frame, const SheetEvidence& evidence);

  double Depth(const Eigen::Vector2d& p) const;  // [mm], by cubic B-splines: twice differentiable
  Eigen::Vector3d Point(const Eigen::Vector2d& p) const { return frame_.RayOf(p).At(Depth(p)); }  // [mm]
  Eigen::Vector3d Normal(const Eigen::Vector2d& p) const;  // unit, towards the thorax
  // The outermost p of that azimuth (a unit vector) whose point stands at the height z [mm].
  Eigen::Vector2d AtHeight(const Eigen::Vector2d& azimuth, double z) const;
  // What the sheet went by at p: the nearest sight within 10 mm that it agrees with.
  Sight SightAt(const Eigen::Vector2d& p) const;

 private:
  CageFrame frame_;
  SheetEvidence evidence_;
  Eigen::VectorXd depth_;
};

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_SMOOTH_SHEET_H_
