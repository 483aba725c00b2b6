// The making of one patient as a job of a queue.
#ifndef PHRENIC_SERVER_SESSION_PATIENT_PATIENT_JOB_H_
#define PHRENIC_SERVER_SESSION_PATIENT_PATIENT_JOB_H_

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "phrenic/v1/patients.pb.h"
#include "server/imaging/labels/label_input.h"
#include "server/imaging/patient/patient.h"
#include "server/jobs/queue.h"
#include "server/session/uploads.h"

namespace phrenic::session {

// Voxels of a volume that a client sends: 512 x 512 x 1,024. Reading it takes up to four times as many bytes.
inline constexpr std::size_t kMostVoxels = std::size_t{1} << 28;

// Reads an uploaded label volume, with its labels' meanings by the map of that name (imaging::ReadMaps). The errors of
// imaging::ParseLabelInput, which `stopped` ends; RESOURCE_EXHAUSTED above kMostVoxels; INVALID_ARGUMENT for an unknown
// map.
absl::StatusOr<imaging::LabelInput> ReadLabelUpload(const Uploads::Held& labels, const std::string& map,
                                                    const std::function<bool()>& stopped);
// Returns "DICOM", "NIfTI" or "archive", by the first bytes.
std::string LabelFormat(const Uploads::Held& labels);

// What a patient is made from.
struct PatientStart {
  Uploads::Held labels;
  v1::CreatePatientRequest request;
  v1::Scene pattern;  // the scene "thorax"
  Requester by;       // without `cancelled`
};

// Makes a patient's surfaces and scene (imaging::MakePatient). The queue calls it (jobs::Queue), Finish under its lock.
// Run uses a thread of the queue, and is called once. The surfaces become uploads of the owner; the job holds them as
// long as it exists.
class PatientJob {
 public:
  using Message = v1::Patient;

  // `uploads` outlives the job.
  PatientJob(PatientStart start, Uploads& uploads) : start_(std::move(start)), uploads_(uploads) {}

  // The errors of ReadLabelUpload, ApplyLabels and imaging::MakePatient. FAILED_PRECONDITION if the volume is not
  // usable and the request does not insist; RESOURCE_EXHAUSTED if the owner's uploads have no room for the surfaces;
  // CANCELLED if the patient was deleted.
  absl::Status Run(jobs::Progress<v1::Patient> progress);
  // Adds the report, and the scene if `status` is OK, and frees the label volume.
  void Finish(const absl::Status& status, absl::Time expires, v1::Patient& message);
  // Does nothing: a patient is not saved.
  void Save(const v1::Patient& /*message*/, const jobs::Records& /*records*/) {}

 private:
  absl::StatusOr<imaging::Patient> Make(imaging::PatientProgress progress) const;
  // Uploads the surfaces of the bodies, and names the uploads in the scene.
  absl::Status UploadSurfaces(const std::vector<imaging::PatientBody>& bodies);

  PatientStart start_;  // labels are empty after Finish
  Uploads& uploads_;
  std::vector<Uploads::Held> surfaces_;
  v1::PatientReport report_;
  v1::Scene scene_;
};

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_PATIENT_PATIENT_JOB_H_
