// The patients of a server: queued, made one at a time, kept for a while.
#ifndef PHRENIC_SERVER_SESSION_PATIENT_PATIENTS_H_
#define PHRENIC_SERVER_SESSION_PATIENT_PATIENTS_H_

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "phrenic/v1/patients.pb.h"
#include "server/jobs/queue.h"
#include "server/schema/clock.h"
#include "server/session/limits.h"
#include "server/session/models.h"
#include "server/session/patient/patient_job.h"
#include "server/session/uploads.h"

namespace phrenic::session {

// Thread-safe. One thread of its own makes the patients. The server owns one (service/server.cc). No store keeps them:
// a label volume is in memory while it is read, and in the unnamed file of its upload.
class Patients {
 public:
  // All outlive it. Of `limits` it uses kept_exports, export_minutes and share.
  Patients(Models& models, Uploads& uploads, const Limits& limits, const Clock& clock);

  // Returns the table of an uploaded volume (DescribeLabels). NOT_FOUND for an upload that the requester does not have;
  // the errors of ReadLabelUpload and imaging::ReadLabelMap. Runs on the calling thread, for seconds; `stopped` ends
  // it.
  absl::StatusOr<v1::InspectLabelsResponse> Inspect(const v1::InspectLabelsRequest& request, const Requester& by,
                                                    const std::function<bool()>& stopped);
  // Queues a patient. NOT_FOUND for an upload that the requester does not have, or a server without the scene "thorax";
  // INVALID_ARGUMENT for more than 1,000 labels; the errors of jobs::Queue::Add.
  absl::StatusOr<v1::Patient> Add(const v1::CreatePatientRequest& request, const Requester& by);
  // The same as the methods of jobs::Queue.
  absl::Status Watch(const std::string& id, absl::FunctionRef<bool()> gone,
                     absl::FunctionRef<bool(v1::Patient message)> write) const {
    return queue_.Watch(id, gone, write);
  }
  std::vector<v1::Patient> List(const std::function<bool(const std::string& owner)>& visible) const {
    return queue_.List(visible);
  }
  std::optional<std::string> OwnerOf(const std::string& id) const { return queue_.OwnerOf(id); }
  absl::Status Delete(const std::string& id) { return queue_.Delete(id); }

 private:
  Models& models_;
  Uploads& uploads_;
  jobs::Queue<PatientJob> queue_;
};

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_PATIENT_PATIENTS_H_
