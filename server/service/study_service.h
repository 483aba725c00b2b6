// v1.StudyService: numerical studies, and checks of a breath against published physiology.
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
#include "server/study/jobs.h"

namespace phrenic::service {

// Thread-safe: gRPC calls the methods on its own threads. Errors as in the proto of each method.
class StudyService final : public v1::StudyService::Service {
 public:
  // `web_root` contains report.html. `store` is null if studies are not saved.
  StudyService(session::Models& models, std::string web_root, AccessGuard& guard, store::Store* store);
  // Restores the studies that an earlier server saved: finished ones as they are, the others run again. Call it before
  // the first RPC. Adds an error to `lost`, by "study ID", for each that cannot be restored; it stays in the store.
  void Restore(const std::vector<store::SavedRecord>& records, std::map<std::string, absl::Status>& lost);

  grpc::Status CreateStudy(grpc::ServerContext* context, const v1::CreateStudyRequest* request,
                           v1::CreateStudyResponse* response) override;
  // RESOURCE_EXHAUSTED above 16 watchers, each of which occupies a thread.
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
  absl::StatusOr<v1::Study> Run(const v1::CreateStudyRequest& request);
  void Save(const v1::Study& study, const v1::CreateStudyRequest* request) const;
  absl::Status Watch(const std::string& id, grpc::ServerContext& context,
                     grpc::ServerWriter<v1::WatchStudyResponse>& writer) const;

  session::Models& models_;
  const std::string web_root_;
  AccessGuard& guard_;
  store::Store* const store_;
  study::Jobs jobs_;
  std::atomic<int> watchers_ = 0;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_STUDY_SERVICE_H_
