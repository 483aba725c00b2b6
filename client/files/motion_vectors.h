// Motion vectors of landmarks as a file: .vtp for ParaView and 3D Slicer, any other ending CSV. In mm, LPS.
#ifndef PHRENIC_CLIENT_FILES_MOTION_VECTORS_H_
#define PHRENIC_CLIENT_FILES_MOTION_VECTORS_H_

#include <string>

#include "absl/status/status.h"
#include "server/fit/motion_fit.h"

namespace phrenic::client {

// Writes what a fit leaves: in a CSV per landmark its place at end exhale, its motion, the predicted motion, the
// residual (motion - predicted) and whether it is of the held-out half; in a .vtp a line from each predicted place at
// end inhale to the true one. DATA_LOSS names the file if it cannot be written.
absl::Status WriteResiduals(const std::string& file, const fit::MotionFit& fit);

// Writes the expected motion of points (3 x n) [m] and its standard deviation at each [m]; in a .vtp a line from each
// point to its expected place.
absl::Status WriteExpected(const std::string& file, const Points& exhale, const Points& motion,
                           const Eigen::VectorXd& spread);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_FILES_MOTION_VECTORS_H_
