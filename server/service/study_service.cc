#include "server/service/study_service.h"

#include "server/mechanics/presets.h"
#include "server/schema/schema.h"
#include "server/service/status.h"
#include "server/service/study_page.h"
#include "server/study/physiology.h"
#include "server/study/run.h"

namespace phrenic::service {
namespace {

constexpr int kMostWatchers = 16;                          // each has a thread of its own
constexpr absl::Duration kLook = absl::Milliseconds(200);  // between two looks at whether the watcher is still there

const char* KindOf(const v1::CreateStudyRequest& request) {
  switch (request.what_case()) {
    case v1::CreateStudyRequest::kError:
      return "error";
    case v1::CreateStudyRequest::kStability:
      return "stability";
    case v1::CreateStudyRequest::kCost:
      return "cost";
    case v1::CreateStudyRequest::WHAT_NOT_SET:
      break;
  }
  return nullptr;
}

}  // namespace

grpc::Status StudyService::CreateStudy(grpc::ServerContext*, const v1::CreateStudyRequest* request,
                                       v1::CreateStudyResponse* response) {
  if (absl::Status status = schema::Validate(*request); !status.ok()) return ToGrpc(status);
  const char* kind = KindOf(*request);
  if (kind == nullptr) return ToGrpc(absl::InvalidArgumentError("what: must be set: error, stability or cost"));
  const auto scene = models_.Resolve(request->source());
  if (!scene.ok()) return ToGrpc(scene.status());
  const auto preset = FindPreset(*scene, request->preset());
  if (!preset.ok()) return ToGrpc(preset.status());
  const auto work = [this, copy = *request](const study::Progress& progress) {
    return study::Run(
        copy, [this](const v1::SceneSource& source) { return models_.Get(source); }, progress);
  };
  auto study = jobs_.Add(request->study_id(), kind, scene->name(), work);
  if (!study.ok()) return ToGrpc(study.status());
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
    if (!writer.Write(response) || seen->ended) return absl::OkStatus();
  }
  return absl::OkStatus();
}

grpc::Status StudyService::WatchStudy(grpc::ServerContext* context, const v1::WatchStudyRequest* request,
                                      grpc::ServerWriter<v1::WatchStudyResponse>* writer) {
  if (absl::Status status = schema::Validate(*request); !status.ok()) return ToGrpc(status);
  absl::Status watched = absl::ResourceExhaustedError("16 callers watch studies, and no more are allowed: try later");
  if (watchers_.fetch_add(1) < kMostWatchers) watched = Watch(request->study_id(), *context, *writer);
  watchers_.fetch_sub(1);
  return ToGrpc(watched);
}

grpc::Status StudyService::ListStudies(grpc::ServerContext*, const v1::ListStudiesRequest*,
                                       v1::ListStudiesResponse* response) {
  for (v1::Study& study : jobs_.List()) *response->add_studies() = std::move(study);
  return grpc::Status::OK;
}

grpc::Status StudyService::DeleteStudy(grpc::ServerContext*, const v1::DeleteStudyRequest* request,
                                       v1::DeleteStudyResponse*) {
  if (absl::Status status = schema::Validate(*request); !status.ok()) return ToGrpc(status);
  return ToGrpc(jobs_.Delete(request->study_id()));
}

grpc::Status StudyService::GetStudyPage(grpc::ServerContext*, const v1::GetStudyPageRequest* request,
                                        v1::GetStudyPageResponse* response) {
  if (absl::Status status = schema::Validate(*request); !status.ok()) return ToGrpc(status);
  const auto seen = jobs_.Wait(request->study_id(), 0, absl::ZeroDuration());
  if (!seen.ok()) return ToGrpc(seen.status());
  auto page = StudyPage(seen->study, web_root_);
  if (!page.ok()) return ToGrpc(page.status());
  response->set_html(*std::move(page));
  return grpc::Status::OK;
}

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
