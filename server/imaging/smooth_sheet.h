// A smoothing spline through the evidence for the diaphragm.
#ifndef PHRENIC_SERVER_IMAGING_SMOOTH_SHEET_H_
#define PHRENIC_SERVER_IMAGING_SMOOTH_SHEET_H_

#include <Eigen/Core>

#include "server/imaging/sheet_evidence.h"

namespace phrenic::imaging {

// A smooth depth r(p) along the rays of a frame. Minimises over the grid
//   sum w (r - observed)^2 + b sum (Laplacian r)^2
// (ThinPlate), which extrapolates where nothing was observed.
// Four rounds of reweighting with w = 1 / (1 + (residual / 6 mm)^2) suppress outliers; b = 4. Of a
// labelled diaphragm, b = 0.3 and 30 mm. Immutable, thread-safe.
class SmoothSheet {
 public:
  SmoothSheet(const CageFrame& frame, const SheetEvidence& evidence);

  double Depth(const Eigen::Vector2d& p) const;  // [mm], a cubic B-spline (C2)
  Eigen::Vector3d Point(const Eigen::Vector2d& p) const { return frame_.RayOf(p).At(Depth(p)); }  // [mm]
  // Returns the outermost p with this azimuth (a unit vector) whose point has height z [mm].
  Eigen::Vector2d AtHeight(const Eigen::Vector2d& azimuth, double z) const;
  // Returns the source of the nearest evidence within 10 mm of p that agrees with the sheet to 8 mm, the wall
  // alone left out; else kNone.
  Source SourceAt(const Eigen::Vector2d& p) const;

 private:
  CageFrame frame_;
  SheetEvidence evidence_;
  Eigen::VectorXd depth_;
};

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_SMOOTH_SHEET_H_
