// Where the diaphragm ends: the costal margin, the arcuate ligaments and the crura.
#ifndef PHRENIC_SERVER_IMAGING_RIM_H_
#define PHRENIC_SERVER_IMAGING_RIM_H_

#include "server/anatomy/diaphragm_shape.h"
#include "server/imaging/smooth_sheet.h"

namespace phrenic::imaging {

// The border of the sheet as a closed loop of the frame's plane, anticlockwise seen from above, densely sampled. In
// front it begins at the sternum's end, follows the lowest cartilage and rib (7 to 12) of each direction round the
// side, and goes over the arcuate ligaments at L1 into the crura, the right one to L3, the left one to L2, with T12
// between (anatomy as in the project's physiology notes). Where ribs and cartilages leave a gap it is bridged; a
// sentence says so.
anatomy::PlaneLoop FindRim(const LabelVolume& volume, const std::vector<Part>& parts, const CageFrame& frame,
                           const SmoothSheet& sheet, Sentences& fallbacks);

// Below the arcuate ligaments, beside the spine.
bool InCrus(const CageFrame& frame, const Eigen::Vector3d& point, v1::Side side);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_RIM_H_
