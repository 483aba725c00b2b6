// A patient's files in a data folder: DATA/scenes/NAME.textproto, DATA/NAME/BODY.msh, DATA/NAME/report.json.
#ifndef PHRENIC_CLIENT_FILES_PATIENT_FILES_H_
#define PHRENIC_CLIENT_FILES_PATIENT_FILES_H_

#include <string>

#include "absl/status/status.h"
#include "server/imaging/patient.h"

namespace phrenic::client {

std::string SceneFile(const std::string& folder, const std::string& name);

// Makes the folders that are not there; a patient of the same name is replaced, the scene last. DATA_LOSS or
// PERMISSION_DENIED names what cannot be written.
absl::Status WritePatient(const std::string& folder, const imaging::Patient& patient);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_FILES_PATIENT_FILES_H_
