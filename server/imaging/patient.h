// From a label volume to a thorax that breathes: surfaces, diaphragm, scene, and a report of what had to be guessed.
#ifndef PHRENIC_SERVER_IMAGING_PATIENT_H_
#define PHRENIC_SERVER_IMAGING_PATIENT_H_

#include <string>
#include <string_view>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "phrenic/v1/patient.pb.h"
#include "server/imaging/derived_diaphragm.h"
#include "server/imaging/label_volume.h"

namespace phrenic::imaging {

struct PatientOptions {
  std::string name = "patient";  // of the scene, and of the folder of its surfaces
  double edge_length = 4;        // of bones [mm]; lungs get half as much again
  DiaphragmOptions diaphragm;
};

struct PatientBody {
  std::string name;
  v1::Anatomy anatomy;
  Mesh mesh;  // [m], LPS, the midsagittal plane at x = 0
};

struct Patient {
  std::vector<PatientBody> bodies;
  v1::Scene scene;  // its surfaces are the files NAME/BODY.msh of the data folder, in millimetres
  v1::PatientReport report;
};

// Told how much is done, 0 to 1, and what is being done; false stops it.
using PatientProgress = absl::FunctionRef<bool(double done, std::string_view doing)>;

// `pattern` is the scene whose forces, breath and presets the patient gets, scaled to the patient's width: the shipped
// "thorax". Every part is moved sideways by one distance (in the report), so that the spine's middle is x = 0, where
// the scene language has its midsagittal plane. FAILED_PRECONDITION where the volume has no lungs, ribs or vertebrae,
// or is no thorax; CANCELLED where the progress says so.
absl::StatusOr<Patient> MakePatient(const LabelVolume& volume, const v1::LabelMap& map, const v1::Scene& pattern,
                                    const PatientOptions& options, PatientProgress progress);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_PATIENT_H_
