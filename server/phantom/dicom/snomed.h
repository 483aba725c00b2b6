// SNOMED CT codes of structures, as DICOM objects name them (PS3.16, CID 4031 and 7150 to 7168).
#ifndef PHRENIC_SERVER_PHANTOM_DICOM_SNOMED_H_
#define PHRENIC_SERVER_PHANTOM_DICOM_SNOMED_H_

#include <string>

#include "phrenic/v1/scene.pb.h"

namespace phrenic::phantom {

// A code of the scheme SCT.
struct Code {
  std::string value, meaning;
};

// Returns the code of a structure; "Tissue" for one without an anatomy, and for the inner face of the cage.
Code CodeOf(const v1::Anatomy& anatomy);
// Returns the code of a side; empty for a structure in the middle.
Code CodeOf(v1::Side side);

}  // namespace phrenic::phantom

#endif  // PHRENIC_SERVER_PHANTOM_DICOM_SNOMED_H_
