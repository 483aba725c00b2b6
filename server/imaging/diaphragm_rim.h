// The rim of the derived diaphragm: costal margin, arcuate ligaments and crura.
#ifndef PHRENIC_SERVER_IMAGING_DIAPHRAGM_RIM_H_
#define PHRENIC_SERVER_IMAGING_DIAPHRAGM_RIM_H_

#include "server/anatomy/diaphragm_shape.h"
#include "server/imaging/smooth_sheet.h"

namespace phrenic::imaging {

// Returns the rim as a closed, densely sampled loop in the frame's plane, counter-clockwise seen from above. It starts
// at the sternum's lower end, follows the lowest cartilage or rib (7 to 12) of each direction, and continues over the
// arcuate ligaments at L1 into the crura, the right one to L3, the left one to L2, with T12 between (anatomy from the
// project's physiology notes). If the diaphragm itself is labelled, the rim follows its lowest points instead, and its
// crura. Interpolates over gaps between ribs and cartilages and adds a message to `fallbacks`.
anatomy::PlaneLoop FindRim(const LabelVolume& volume, const std::vector<Part>& parts, const CageFrame& frame,
                           const SmoothSheet& sheet, Fallbacks& fallbacks);

// True if a point [mm] is in the crus of that side: beside the spine, below the arcuate ligaments.
bool InCrus(const CageFrame& frame, const Eigen::Vector3d& point, v1::Side side);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_DIAPHRAGM_RIM_H_
