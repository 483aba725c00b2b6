// v1.StudyService: numerical studies, and checks of a breath against published physiology.
#ifndef PHRENIC_SERVER_SERVICE_STUDY_SERVICE_H_
#define PHRENIC_SERVER_SERVICE_STUDY_SERVICE_H_

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "phrenic/v1/study.pb.h"
#include "server/service/calls/access_guard.h"
#include "server/service/calls/call_table.h"
#include "server/service/calls/fair_share.h"
#include "server/session/limits.h"
#include "server/session/models.h"
#include "server/store/store.h"
#include "server/study/studies.h"

namespace phrenic::service {

// Thread-safe: the methods run on threads of their lanes. Errors as in the proto of each method.
class StudyService final {
 public:
  // `web_root` contains report.html. `store` is null if studies are not saved. All outlive the service.
  StudyService(session::Models& models, std::string web_root, AccessGuard& guard, const Clock& clock,
               const session::Limits& limits, store::Store* store);
  // The same as study::Studies::Restore. Call it before the first RPC.
  void Restore(const std::vector<store::SavedRecord>& records, std::map<std::string, absl::Status>& lost);

  // Adds the methods to the table. The service outlives it.
  void AddTo(CallTable& calls);

  grpc::Status CreateStudy(grpc::CallbackServerContext* context, const v1::CreateStudyRequest* request,
                           v1::CreateStudyResponse* response);
  grpc::Status WatchStudy(grpc::CallbackServerContext* context, const v1::WatchStudyRequest* request,
                          ReplyStream<v1::WatchStudyResponse>* writer);
  grpc::Status ListStudies(grpc::CallbackServerContext* context, const v1::ListStudiesRequest* request,
                           v1::ListStudiesResponse* response);
  grpc::Status DeleteStudy(grpc::CallbackServerContext* context, const v1::DeleteStudyRequest* request,
                           v1::DeleteStudyResponse* response);
  grpc::Status GetStudyPage(grpc::CallbackServerContext* context, const v1::GetStudyPageRequest* request,
                            v1::GetStudyPageResponse* response);
  grpc::Status CheckPhysiology(grpc::CallbackServerContext* context, const v1::CheckPhysiologyRequest* request,
                               ReplyStream<v1::CheckPhysiologyResponse>* writer);

 private:
  session::Models& models_;
  const std::string web_root_;
  AccessGuard& guard_;
  FairShare checks_;  // of physiology, that run
  study::Studies studies_;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_STUDY_SERVICE_H_
