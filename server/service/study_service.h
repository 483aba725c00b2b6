// Studies: what reviewers read.
#ifndef PHRENIC_SERVER_SERVICE_STUDY_SERVICE_H_
#define PHRENIC_SERVER_SERVICE_STUDY_SERVICE_H_

#include "phrenic/v1/study.grpc.pb.h"
#include "server/session/models.h"

namespace phrenic::service {

// gRPC's threads call, any number at a time.
class StudyService final : public v1::StudyService::Service {
 public:
  explicit StudyService(session::Models& models) : models_(models) {}

  grpc::Status CheckPhysiology(grpc::ServerContext* context, const v1::CheckPhysiologyRequest* request,
                               grpc::ServerWriter<v1::CheckPhysiologyResponse>* writer) override;

 private:
  session::Models& models_;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_STUDY_SERVICE_H_
