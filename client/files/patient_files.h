// A patient's files in a data folder: DATA/scenes/NAME.textproto, DATA/NAME/BODY.msh, DATA/NAME/report.json.
#ifndef PHRENIC_CLIENT_FILES_PATIENT_FILES_H_
#define PHRENIC_CLIENT_FILES_PATIENT_FILES_H_

#include <string>

#include "absl/status/status.h"
#include "server/imaging/patient/patient.h"

namespace phrenic::client {

// Returns DATA/scenes/NAME.textproto.
std::string SceneFile(const std::string& folder, const std::string& name);

// Writes the scene's file alone, and creates missing folders. Errors as WritePatient.
absl::Status WriteScene(const std::string& folder, const v1::Scene& scene);

// Writes the patient's files and creates missing folders. Replaces a patient of the same name; writes the scene last.
// DATA_LOSS or PERMISSION_DENIED names the file or folder that cannot be written.
absl::Status WritePatient(const std::string& folder, const imaging::Patient& patient);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_FILES_PATIENT_FILES_H_
