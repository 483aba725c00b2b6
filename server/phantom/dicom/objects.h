// A phantom's phase as DICOM objects, written by DCMTK (https://dcmtk.org) in explicit VR little endian.
#ifndef PHRENIC_SERVER_PHANTOM_DICOM_OBJECTS_H_
#define PHRENIC_SERVER_PHANTOM_DICOM_OBJECTS_H_

#include <string>

#include "absl/status/statusor.h"
#include "server/phantom/breathing_phantom.h"
#include "server/phantom/dicom/study.h"
#include "server/phantom/structures.h"

namespace phrenic::phantom {

// Returns a Segmentation (SEG; PS3.3, A.51): BINARY, a segment for each structure that has a voxel, with its SNOMED
// code, side and colour; empty slices have no frame. FAILED_PRECONDITION if no structure has a voxel.
absl::StatusOr<std::string> WriteSegmentation(const DicomStudy& study, const Structures& structures,
                                              const PhantomPhase& rendered, int phase);

// Returns a slice of a CT image series (PS3.3, A.3), k from 0. Requires: the phase has a CT.
absl::StatusOr<std::string> WriteCtSlice(const DicomStudy& study, const PhantomPhase& rendered, int phase, int k);

enum class ModelFormat { kStl, kObj };

// Returns an Encapsulated STL or OBJ (PS3.3, A.85.1 and A.85.2) of a file of surfaces in millimetres, LPS.
absl::StatusOr<std::string> WriteModel(const DicomStudy& study, ModelFormat format, const std::string& model,
                                       double time, int phase);

}  // namespace phrenic::phantom

#endif  // PHRENIC_SERVER_PHANTOM_DICOM_OBJECTS_H_
