#include "server/service/study_service.h"

#include "phrenic/v1/saved.pb.h"
#include "server/mechanics/compile/presets.h"
#include "server/physiology/physiology.h"
#include "server/service/calls/status.h"
#include "server/service/study_page.h"
#include "server/study/run.h"

namespace phrenic::service {
namespace {

constexpr char kRecord[] = "study";
constexpr int kMaxStudies = 16;
constexpr int kMaxWatchers = 16;                           // each occupies a thread
constexpr absl::Duration kLook = absl::Milliseconds(200);  // period of the check whether the watcher disconnected

const char* KindOf(const v1::CreateStudyRequest& request) {
  switch (request.what_case()) {
    case v1::CreateStudyRequest::kError:
      return "error";
    case v1::CreateStudyRequest::kStability:
      return "stability";
    case v1::CreateStudyRequest::kCost:
      return "cost";
    case v1::CreateStudyRequest::kStreaming:
      return "streaming";
    case v1::CreateStudyRequest::WHAT_NOT_SET:
      break;
  }
  return nullptr;
}

}  // namespace

StudyService::StudyService(session::Models& models, std::string web_root, AccessGuard& guard, store::Store* store)
    : models_(models),
      web_root_(std::move(web_root)),
      guard_(guard),
      store_(store),
      jobs_(kMaxStudies, {[this](const v1::Study& study) { Save(study, nullptr); },
                          [this](const std::string& id) {
                            if (store_ != nullptr) store_->Remove(kRecord, id);
                          }}) {}

void StudyService::Save(const v1::Study& study, const v1::CreateStudyRequest* request) const {
  if (store_ == nullptr) return;
  v1::SavedStudy saved;
  if (request != nullptr) *saved.mutable_request() = *request;
  *saved.mutable_study() = study;
  saved.set_owner(guard_.OwnerOf(AccessGuard::Kind::kStudy, study.id()));
  store_->Put(kRecord, study.id(), saved.SerializeAsString());
}

void StudyService::Restore(const std::vector<store::SavedRecord>& records, std::map<std::string, absl::Status>& lost) {
  for (const store::SavedRecord& record : records) {
    if (record.kind != kRecord) continue;
    v1::SavedStudy saved;
    if (!record.problem.ok() || !saved.ParseFromString(record.bytes)) {
      lost[absl::StrCat(kRecord, " ", record.id)] =
          record.problem.ok() ? absl::DataLossError("the record in the store is not a study") : record.problem;
      continue;
    }
    guard_.SetOwner(AccessGuard::Kind::kStudy, record.id, saved.owner());
    if (!saved.has_request()) {
      jobs_.Restore(saved.study());
    } else if (const auto again = Run(saved.request()); !again.ok()) {
      saved.mutable_study()->set_state(v1::STUDY_STATE_FAILED);
      saved.mutable_study()->set_problem(std::string(again.status().message()));
      jobs_.Restore(saved.study());
    }
  }
}

absl::StatusOr<v1::Study> StudyService::Run(const v1::CreateStudyRequest& request) {
  const char* kind = KindOf(request);
  if (kind == nullptr) return absl::InvalidArgumentError("what: must be set: error, stability, cost or streaming");
  const auto scene = models_.Resolve(request.source());
  if (!scene.ok()) return scene.status();
  const auto preset = FindPreset(*scene, request.preset());
  if (!preset.ok()) return preset.status();
  const auto work = [this, copy = request](const study::Progress& progress) {
    return study::Run(
        copy, [this](const v1::SceneSource& source) { return models_.Get(source); }, progress);
  };
  return jobs_.Add(request.study_id(), kind, scene->name(), work);
}

grpc::Status StudyService::CreateStudy(grpc::ServerContext* context, const v1::CreateStudyRequest* request,
                                       v1::CreateStudyResponse* response) {
  const auto caller = guard_.Admit(*context, *request);
  if (!caller.ok()) return ToGrpc(caller.status());
  auto study = Run(*request);
  if (!study.ok()) return ToGrpc(study.status());
  guard_.SetOwner(AccessGuard::Kind::kStudy, study->id(), caller->id());
  v1::CreateStudyRequest again = *request;
  again.set_study_id(study->id());
  Save(*study, &again);
  if (absl::Status saved = store_ == nullptr ? absl::OkStatus() : store_->FlushRecords(); !saved.ok()) {
    jobs_.Delete(study->id()).IgnoreError();
    return ToGrpc(saved);
  }
  *response->mutable_study() = *std::move(study);
  return grpc::Status::OK;
}

absl::Status StudyService::Watch(const std::string& id, grpc::ServerContext& context,
                                 grpc::ServerWriter<v1::WatchStudyResponse>& writer) const {
  std::int64_t version = 0;
  while (!context.IsCancelled()) {
    auto seen = jobs_.Wait(id, version, kLook);
    if (!seen.ok()) return seen.status();
    if (seen->version == version) continue;
    version = seen->version;
    v1::WatchStudyResponse response;
    *response.mutable_study() = std::move(seen->study);
    if (!writer.Write(response)) break;
    if (seen->ended) return absl::OkStatus();
  }
  return absl::UnavailableError("the server is shutting down");  // or the client disconnected
}

grpc::Status StudyService::WatchStudy(grpc::ServerContext* context, const v1::WatchStudyRequest* request,
                                      grpc::ServerWriter<v1::WatchStudyResponse>* writer) {
  const auto caller = guard_.Admit(*context, *request);
  if (!caller.ok()) return ToGrpc(caller.status());
  if (absl::Status own = guard_.CheckOwns(AccessGuard::Kind::kStudy, request->study_id(), *caller); !own.ok())
    return ToGrpc(own);
  absl::Status watched =
      absl::ResourceExhaustedError("16 clients are watching studies, which is the limit; try again later");
  if (watchers_.fetch_add(1) < kMaxWatchers) watched = Watch(request->study_id(), *context, *writer);
  watchers_.fetch_sub(1);
  return ToGrpc(watched);
}

grpc::Status StudyService::ListStudies(grpc::ServerContext* context, const v1::ListStudiesRequest* request,
                                       v1::ListStudiesResponse* response) {
  const auto caller = guard_.Admit(*context, *request);
  if (!caller.ok()) return ToGrpc(caller.status());
  for (v1::Study& study : jobs_.List()) {
    if (guard_.Owns(AccessGuard::Kind::kStudy, study.id(), *caller)) *response->add_studies() = std::move(study);
  }
  return grpc::Status::OK;
}

grpc::Status StudyService::DeleteStudy(grpc::ServerContext* context, const v1::DeleteStudyRequest* request,
                                       v1::DeleteStudyResponse*) {
  const auto caller = guard_.Admit(*context, *request);
  if (!caller.ok()) return ToGrpc(caller.status());
  if (absl::Status own = guard_.CheckOwns(AccessGuard::Kind::kStudy, request->study_id(), *caller); !own.ok())
    return ToGrpc(own);
  return ToGrpc(jobs_.Delete(request->study_id()));
}

grpc::Status StudyService::GetStudyPage(grpc::ServerContext* context, const v1::GetStudyPageRequest* request,
                                        v1::GetStudyPageResponse* response) {
  const auto caller = guard_.Admit(*context, *request);
  if (!caller.ok()) return ToGrpc(caller.status());
  if (absl::Status own = guard_.CheckOwns(AccessGuard::Kind::kStudy, request->study_id(), *caller); !own.ok())
    return ToGrpc(own);
  const auto seen = jobs_.Wait(request->study_id(), 0, absl::ZeroDuration());
  if (!seen.ok()) return ToGrpc(seen.status());
  auto page = StudyPage(seen->study, web_root_);
  if (!page.ok()) return ToGrpc(page.status());
  response->set_html(*std::move(page));
  return grpc::Status::OK;
}

grpc::Status StudyService::CheckPhysiology(grpc::ServerContext* context, const v1::CheckPhysiologyRequest* request,
                                           grpc::ServerWriter<v1::CheckPhysiologyResponse>* writer) {
  const auto caller = guard_.Admit(*context, *request);
  if (!caller.ok()) return ToGrpc(caller.status());
  const auto model = models_.Get(request->source());
  if (!model.ok()) return ToGrpc(model.status());
  v1::CheckPhysiologyResponse response;
  const auto table = physiology::CheckPhysiology(**model, [&](double done) {
    response.set_progress(done);
    return writer->Write(response) && !context->IsCancelled();
  });
  if (!table.ok()) return ToGrpc(table.status());
  *response.mutable_table() = *table;
  writer->Write(response);
  return grpc::Status::OK;
}

}  // namespace phrenic::service
