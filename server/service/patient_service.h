// v1.PatientService: breathing patients from uploaded label volumes.
#ifndef PHRENIC_SERVER_SERVICE_PATIENT_SERVICE_H_
#define PHRENIC_SERVER_SERVICE_PATIENT_SERVICE_H_

#include "phrenic/v1/patients.pb.h"
#include "server/service/calls/access_guard.h"
#include "server/service/calls/call_table.h"
#include "server/service/calls/fair_share.h"
#include "server/session/limits.h"
#include "server/session/patient/patients.h"

namespace phrenic::service {

// Thread-safe: the methods run on threads of their lanes, a watcher until its patient ends. session::Patients owns the
// jobs and makes them on a thread of its own. A caller may watch and delete what belongs to it; everything else is
// NOT_FOUND. Errors as in the proto of each method.
class PatientService final {
 public:
  // Patients and guard outlive the service. Of `limits` it uses exports, for the volumes that are read at a time, and
  // share.
  PatientService(session::Patients& patients, const session::Limits& limits, AccessGuard& guard);

  // Adds the methods to the table. The service outlives it.
  void AddTo(CallTable& calls);

  // On Lane::kWork, for seconds.
  grpc::Status InspectLabels(grpc::CallbackServerContext* context, const v1::InspectLabelsRequest* request,
                             v1::InspectLabelsResponse* response);
  // On Lane::kSession.
  grpc::Status CreatePatient(grpc::CallbackServerContext* context, const v1::CreatePatientRequest* request,
                             v1::CreatePatientResponse* response);
  // On Lane::kWatch, until the patient ends or the client disconnects. CANCELLED if it is deleted meanwhile.
  grpc::Status WatchPatient(grpc::CallbackServerContext* context, const v1::WatchPatientRequest* request,
                            ReplyStream<v1::WatchPatientResponse>* writer);
  // On Lane::kQuick.
  grpc::Status ListPatients(grpc::CallbackServerContext* context, const v1::ListPatientsRequest* request,
                            v1::ListPatientsResponse* response);
  // On Lane::kSession.
  grpc::Status DeletePatient(grpc::CallbackServerContext* context, const v1::DeletePatientRequest* request,
                             v1::DeletePatientResponse* response);

 private:
  // The errors of AccessGuard::CheckOwns.
  absl::Status CheckOwns(const std::string& id, const access::Caller& caller) const;

  session::Patients& patients_;
  AccessGuard& guard_;
  FairShare inspections_;  // that run
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_PATIENT_SERVICE_H_
