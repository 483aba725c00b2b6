#include "server/service/patient_service.h"

#include <utility>

#include "server/schema/part_of.h"
#include "server/service/calls/status.h"

namespace phrenic::service {

PatientService::PatientService(session::Patients& patients, const session::Limits& limits, AccessGuard& guard)
    : patients_(patients),
      guard_(guard),
      inspections_({"inspections of label volumes", "--max-exports, --max-share", limits.exports,
                    PartOf(limits.exports, limits.share)}) {}

void PatientService::AddTo(CallTable& calls) {
  calls.Add(Lane::kWork, *this, &PatientService::InspectLabels);
  calls.Add(Lane::kSession, *this, &PatientService::CreatePatient);
  calls.Add(Lane::kWatch, *this, &PatientService::WatchPatient);
  calls.Add(Lane::kQuick, *this, &PatientService::ListPatients);
  calls.Add(Lane::kSession, *this, &PatientService::DeletePatient);
}

absl::Status PatientService::CheckOwns(const std::string& id, const access::Caller& caller) const {
  return guard_.CheckOwns(AccessGuard::Kind::kPatient, id, patients_.OwnerOf(id), caller);
}

grpc::Status PatientService::InspectLabels(grpc::CallbackServerContext* context,
                                           const v1::InspectLabelsRequest* request,
                                           v1::InspectLabelsResponse* response) {
  const auto caller = guard_.Admit(*context, *request);
  if (!caller.ok()) return ToGrpc(caller.status());
  const auto running = inspections_.Take(guard_.ShareOf(*caller));
  if (!running.ok()) return ToGrpc(running.status());
  auto table =
      patients_.Inspect(*request, guard_.RequesterOf(*caller, *context), [context] { return context->IsCancelled(); });
  if (!table.ok()) return ToGrpc(table.status());
  *response = *std::move(table);
  return grpc::Status::OK;
}

grpc::Status PatientService::CreatePatient(grpc::CallbackServerContext* context,
                                           const v1::CreatePatientRequest* request,
                                           v1::CreatePatientResponse* response) {
  const auto caller = guard_.Admit(*context, *request);
  if (!caller.ok()) return ToGrpc(caller.status());
  auto patient = patients_.Add(*request, guard_.RequesterOf(*caller, *context));
  if (!patient.ok()) return ToGrpc(patient.status());
  *response->mutable_patient() = *std::move(patient);
  return grpc::Status::OK;
}

grpc::Status PatientService::WatchPatient(grpc::CallbackServerContext* context, const v1::WatchPatientRequest* request,
                                          ReplyStream<v1::WatchPatientResponse>* writer) {
  const auto caller = guard_.Admit(*context, *request);
  if (!caller.ok()) return ToGrpc(caller.status());
  if (absl::Status own = CheckOwns(request->patient_id(), *caller); !own.ok()) return ToGrpc(own);
  v1::WatchPatientResponse response;
  return ToGrpc(patients_.Watch(
      request->patient_id(), [&] { return context->IsCancelled(); },
      [&](v1::Patient patient) {
        *response.mutable_patient() = std::move(patient);
        return writer->Write(response);
      }));
}

grpc::Status PatientService::ListPatients(grpc::CallbackServerContext* context, const v1::ListPatientsRequest* request,
                                          v1::ListPatientsResponse* response) {
  const auto caller = guard_.Admit(*context, *request);
  if (!caller.ok()) return ToGrpc(caller.status());
  const auto visible = [&](const std::string& owner) { return guard_.MayUse(owner, *caller); };
  for (v1::Patient& patient : patients_.List(visible)) {
    patient.clear_report();
    patient.clear_scene();
    *response->add_patients() = std::move(patient);
  }
  return grpc::Status::OK;
}

grpc::Status PatientService::DeletePatient(grpc::CallbackServerContext* context,
                                           const v1::DeletePatientRequest* request, v1::DeletePatientResponse*) {
  const auto caller = guard_.Admit(*context, *request);
  if (!caller.ok()) return ToGrpc(caller.status());
  if (absl::Status own = CheckOwns(request->patient_id(), *caller); !own.ok()) return ToGrpc(own);
  return ToGrpc(patients_.Delete(request->patient_id()));
}

}  // namespace phrenic::service
