// Converts a label volume to a breathing thorax: surfaces, a derived diaphragm, a scene, and a report of assumptions.
#ifndef PHRENIC_SERVER_IMAGING_PATIENT_PATIENT_H_
#define PHRENIC_SERVER_IMAGING_PATIENT_PATIENT_H_

#include <string>
#include <string_view>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "phrenic/v1/patient.pb.h"
#include "server/imaging/derived_diaphragm.h"
#include "server/imaging/label_volume.h"
#include "server/imaging/patient/patient_body.h"

namespace phrenic::imaging {

struct PatientOptions {
  std::string name = "patient";  // of the scene, and of the folder of its surfaces
  double edge_length = 4;        // of bones [mm]; lungs get half as much again
  DiaphragmOptions diaphragm;
  bool fill = true;  // what the volume does not show, from the template (template_parts.h)
};

struct Patient {
  std::vector<PatientBody> bodies;
  v1::Scene scene;  // its surfaces are the files NAME/BODY.msh of the data folder, in millimetres
  v1::PatientReport report;
};

// Receives the progress, 0 to 1, and the current step. Returns false to cancel.
using PatientProgress = absl::FunctionRef<bool(double done, std::string_view doing)>;

// `pattern` is the scene that supplies forces, breath and presets, scaled to the patient's width: the installed scene
// "thorax". All parts are shifted along x by one distance (in the report) so that the midsagittal plane is x = 0, as
// scenes require. Vertices that are the template's are the region "from-template" of their body. FAILED_PRECONDITION if
// the volume has no lungs, ribs or vertebrae and they could not be filled; CANCELLED if `progress` returns false.
absl::StatusOr<Patient> MakePatient(const LabelVolume& volume, const v1::LabelMap& map, const v1::Scene& pattern,
                                    const PatientOptions& options, PatientProgress progress);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_PATIENT_PATIENT_H_
