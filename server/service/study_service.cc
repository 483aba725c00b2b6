#include "server/service/study_service.h"

#include "server/schema/schema.h"
#include "server/service/status.h"
#include "server/study/physiology.h"

namespace phrenic::service {

grpc::Status StudyService::CheckPhysiology(grpc::ServerContext* context, const v1::CheckPhysiologyRequest* request,
                                           grpc::ServerWriter<v1::CheckPhysiologyResponse>* writer) {
  if (absl::Status status = schema::Validate(*request); !status.ok()) return ToGrpc(status);
  const auto model = models_.Get(request->source());
  if (!model.ok()) return ToGrpc(model.status());
  v1::CheckPhysiologyResponse response;
  const auto table = study::CheckPhysiology(**model, [&](double done) {
    response.set_progress(done);
    return writer->Write(response) && !context->IsCancelled();
  });
  if (!table.ok()) return ToGrpc(table.status());
  *response.mutable_table() = *table;
  writer->Write(response);
  return grpc::Status::OK;
}

}  // namespace phrenic::service
