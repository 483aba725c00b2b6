// A person's structures, from surface files or from a label volume.
#ifndef PHRENIC_CLIENT_FILES_PERSON_STRUCTURES_H_
#define PHRENIC_CLIENT_FILES_PERSON_STRUCTURES_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "server/fit/structures.h"

namespace phrenic::client {

// Checks NAME=FILE. INVALID_ARGUMENT names the structures.
absl::Status CheckStructure(const std::string& text);
// Reads NAME=FILE each: a surface file in mm and LPS. NOT_FOUND, or INVALID_ARGUMENT "file: ...".
absl::StatusOr<std::vector<fit::PersonStructure>> ReadStructures(const std::vector<std::string>& texts);
// Reads the lungs off a label volume (NIfTI, DICOM Segmentation), by the map of its numbers. INVALID_ARGUMENT if it has
// no labels of a lung; the errors of imaging::ReadLabels and imaging::SurfaceOf.
absl::StatusOr<std::vector<fit::PersonStructure>> ReadLabelledLungs(const std::string& volume, const std::string& map);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_FILES_PERSON_STRUCTURES_H_
