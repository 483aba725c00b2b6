// Implicit organs next to the generated diaphragm, for phantoms; the generated thorax has no surfaces of them.
#ifndef PHRENIC_SERVER_IMAGING_PHANTOM_ORGANS_H_
#define PHRENIC_SERVER_IMAGING_PHANTOM_ORGANS_H_

#include <Eigen/Core>

#include "phrenic/v1/patient.pb.h"

namespace phrenic::imaging {

// True if a point in the generated thorax' frame [mm] is in the organ: heart, liver, spleen or stomach; false for other
// organs. The organs keep 3.5 to 4 mm from the diaphragm's middle surface and leave gaps between them, like fat.
bool InOrgan(v1::Organ organ, const Eigen::Vector3d& point);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_PHANTOM_ORGANS_H_
