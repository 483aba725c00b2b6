#include "client/files/patient_files.h"

#include <filesystem>

#include "absl/strings/str_cat.h"
#include "client/files/scene_text.h"
#include "client/files/whole_file.h"
#include "client/print/output.h"
#include "server/meshio/meshio.h"

namespace phrenic::client {
namespace {

namespace fs = std::filesystem;

constexpr double kMillimetre = 1e-3;  // [m]

absl::Status MakeFolder(const std::string& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!error) return absl::OkStatus();
  return absl::PermissionDeniedError(absl::StrCat("cannot make the folder ", folder, ": ", error.message()));
}

}  // namespace

std::string SceneFile(const std::string& folder, const std::string& name) {
  return absl::StrCat(folder, "/scenes/", name, ".textproto");
}

absl::Status WriteScene(const std::string& folder, const v1::Scene& scene) {
  if (absl::Status status = MakeFolder(absl::StrCat(folder, "/scenes")); !status.ok()) return status;
  return WriteWhole(SceneFile(folder, scene.name()), SceneText(scene));
}

absl::Status WritePatient(const std::string& folder, const imaging::Patient& patient) {
  const std::string& name = patient.scene.name();
  const std::string surfaces = absl::StrCat(folder, "/", name);
  if (absl::Status status = MakeFolder(surfaces); !status.ok()) return status;
  for (const imaging::PatientBody& body : patient.bodies) {
    const std::string file = absl::StrCat(surfaces, "/", body.name, ".msh");
    const absl::StatusOr<std::string> bytes = meshio::Write(file, body.mesh, kMillimetre);
    if (!bytes.ok()) return bytes.status();
    if (absl::Status status = WriteWhole(file, *bytes); !status.ok()) return status;
  }
  absl::Status status = WriteWhole(absl::StrCat(surfaces, "/report.json"), Json(patient.report) + "\n");
  if (!status.ok()) return status;
  return WriteScene(folder, patient.scene);
}

}  // namespace phrenic::client
