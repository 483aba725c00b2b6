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
#include "server/study/queue/studies.h"

namespace phrenic::service {

// Thread-safe: the methods run on threads of their lanes. Errors as in the proto of each method.
//
// study::Studies, which it owns, runs the studies one at a time on its own thread and keeps 16. A caller may watch,
// read and delete what belongs to it; everything else is NOT_FOUND.
class StudyService final {
 public:
  // `web_root` contains report.html. `store` is null if studies are not saved. All outlive the service. Of `limits` it
  // uses exports, for the physiology checks at a time, and share.
  StudyService(session::Models& models, std::string web_root, AccessGuard& guard, const Clock& clock,
               const session::Limits& limits, store::Store* store);
  // The same as study::Studies::Restore. Call it before the first RPC. Puts into `lost` what cannot be restored.
  void Restore(const std::vector<store::SavedRecord>& records, std::map<std::string, absl::Status>& lost);

  // Adds the methods to the table. The service outlives it.
  void AddTo(CallTable& calls);

  // On Lane::kSession. Resolves scene and preset, but does not compile; returns when the store has the study on the
  // disk.
  grpc::Status CreateStudy(grpc::CallbackServerContext* context, const v1::CreateStudyRequest* request,
                           v1::CreateStudyResponse* response);
  // On Lane::kWatch, until the study ends or the client disconnects.
  grpc::Status WatchStudy(grpc::CallbackServerContext* context, const v1::WatchStudyRequest* request,
                          ReplyStream<v1::WatchStudyResponse>* writer);
  // On Lane::kQuick. An administrator gets all; without accounts everybody does.
  grpc::Status ListStudies(grpc::CallbackServerContext* context, const v1::ListStudiesRequest* request,
                           v1::ListStudiesResponse* response);
  // On Lane::kSession.
  grpc::Status DeleteStudy(grpc::CallbackServerContext* context, const v1::DeleteStudyRequest* request,
                           v1::DeleteStudyResponse* response);
  // On Lane::kQuick. The errors of StudyPage.
  grpc::Status GetStudyPage(grpc::CallbackServerContext* context, const v1::GetStudyPageRequest* request,
                            v1::GetStudyPageResponse* response);
  // On Lane::kWork, for as long as the simulated breaths take. RESOURCE_EXHAUSTED above limits.exports checks at a
  // time, or above a caller's share.
  grpc::Status CheckPhysiology(grpc::CallbackServerContext* context, const v1::CheckPhysiologyRequest* request,
                               ReplyStream<v1::CheckPhysiologyResponse>* writer);
  // The same limits, of their own. Runs on threads of its own; the handler's writes the results.
  grpc::Status RunBatch(grpc::CallbackServerContext* context, const v1::RunBatchRequest* request,
                        ReplyStream<v1::RunBatchResponse>* writer);

 private:
  // The errors of AccessGuard::CheckOwns.
  absl::Status CheckOwns(const std::string& id, const access::Caller& caller) const;

  session::Models& models_;
  const std::string web_root_;
  AccessGuard& guard_;
  FairShare checks_, batches_;  // of physiology, and batches, that run; held by the handler
  // Last: its thread uses the members above.
  study::Studies studies_;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_STUDY_SERVICE_H_
