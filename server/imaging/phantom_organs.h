// The organs beside the generated diaphragm, as laws of place: the generated thorax has no surfaces of them.
#ifndef PHRENIC_SERVER_IMAGING_PHANTOM_ORGANS_H_
#define PHRENIC_SERVER_IMAGING_PHANTOM_ORGANS_H_

#include <Eigen/Core>

#include "phrenic/v1/patient.pb.h"

namespace phrenic::imaging {

// Whether a point of the generated thorax' frame [mm] lies in the organ: heart, liver, spleen or stomach. They keep 3.5
// to 4 mm from the middle of the generated diaphragm, and leave room between them, as fat does.
bool InOrgan(v1::Organ organ, const Eigen::Vector3d& point);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_PHANTOM_ORGANS_H_
