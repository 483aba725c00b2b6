// Where the border of a volume cuts a part.
#ifndef PHRENIC_SERVER_IMAGING_PATIENT_BORDER_H_
#define PHRENIC_SERVER_IMAGING_PATIENT_BORDER_H_

#include <string>

#include "server/imaging/segmented_parts.h"

namespace phrenic::imaging {

// The side of the volume at which most of a part ends.
struct BorderCut {
  double area = 0;   // of the part's voxels on that side [cm^2]
  std::string side;  // "upper", "lower", "left", "right", "front" or "back", of the patient
};

// Returns the largest cut; of area 0 if the part does not reach the border.
BorderCut LargestCut(const LabelVolume& volume, const Part& part);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_PATIENT_BORDER_H_
