// Studies: what reviewers read.
#ifndef PHRENIC_SERVER_SERVICE_STUDY_SERVICE_H_
#define PHRENIC_SERVER_SERVICE_STUDY_SERVICE_H_

#include <atomic>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "phrenic/v1/study.grpc.pb.h"
#include "server/service/calls/access_guard.h"
#include "server/session/models.h"
#include "server/store/store.h"
#include "server/study/studies.h"

namespace phrenic::service {

// gRPC's threads call, any number at a time.
class StudyService final : public v1::StudyService::Service {
 public:
  // `web_root` has report.html, the page without a study. Without a store, studies end with the server. All outlive it.
  StudyService(session::Models& models, std::string web_root, AccessGuard& guard, const Clock& clock,
               store::Store* store);
  // The same as study::Studies::Restore. Requires: no call came yet.
  void Restore(const std::vector<store::SavedRecord>& records, std::map<std::string, absl::Status>& lost);

  grpc::Status CreateStudy(grpc::ServerContext* context, const v1::CreateStudyRequest* request,
                           v1::CreateStudyResponse* response) override;
  // At most 16 watch at a time: RESOURCE_EXHAUSTED for one more.
  grpc::Status WatchStudy(grpc::ServerContext* context, const v1::WatchStudyRequest* request,
                          grpc::ServerWriter<v1::WatchStudyResponse>* writer) override;
  grpc::Status ListStudies(grpc::ServerContext* context, const v1::ListStudiesRequest* request,
                           v1::ListStudiesResponse* response) override;
  grpc::Status DeleteStudy(grpc::ServerContext* context, const v1::DeleteStudyRequest* request,
                           v1::DeleteStudyResponse* response) override;
  grpc::Status GetStudyPage(grpc::ServerContext* context, const v1::GetStudyPageRequest* request,
                            v1::GetStudyPageResponse* response) override;
  grpc::Status CheckPhysiology(grpc::ServerContext* context, const v1::CheckPhysiologyRequest* request,
                               grpc::ServerWriter<v1::CheckPhysiologyResponse>* writer) override;

 private:
  session::Models& models_;
  const std::string web_root_;
  AccessGuard& guard_;
  study::Studies studies_;
  std::atomic<int> watchers_ = 0;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_STUDY_SERVICE_H_
