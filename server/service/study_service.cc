#include "server/service/study_service.h"

#include <utility>

#include "server/mechanics/compile/presets.h"
#include "server/physiology/physiology.h"
#include "server/schema/part_of.h"
#include "server/service/calls/status.h"
#include "server/service/study_page.h"
#include "server/study/batch/run_all.h"

namespace phrenic::service {
StudyService::StudyService(session::Models& models, std::string web_root, AccessGuard& guard, const Clock& clock,
                           const session::Limits& limits, store::Store* store)
    : models_(models),
      web_root_(std::move(web_root)),
      guard_(guard),
      checks_(
          {"physiology checks", "--max-exports, --max-share", limits.exports, PartOf(limits.exports, limits.share)}),
      batches_({"batches", "--max-exports, --max-share", limits.exports, PartOf(limits.exports, limits.share)}),
      studies_(
          [this](const v1::CreateStudyRequest& request) -> absl::StatusOr<std::string> {
            const auto scene = models_.Resolve(request.source());
            if (!scene.ok()) return scene.status();
            const auto preset = FindPreset(*scene, request.preset());
            if (!preset.ok()) return preset.status();
            return scene->name();
          },
          [this](const v1::SceneSource& source, const std::string& owner, const std::function<bool()>& cancelled) {
            return models_.Get(source, {.owner = owner, .share = "studies " + owner, .cancelled = cancelled});
          },
          clock, store, limits.share) {}

void StudyService::AddTo(CallTable& calls) {
  calls.Add(Lane::kSession, *this, &StudyService::CreateStudy);
  calls.Add(Lane::kWatch, *this, &StudyService::WatchStudy);
  calls.Add(Lane::kQuick, *this, &StudyService::ListStudies);
  calls.Add(Lane::kSession, *this, &StudyService::DeleteStudy);
  calls.Add(Lane::kQuick, *this, &StudyService::GetStudyPage);
  calls.Add(Lane::kWork, *this, &StudyService::CheckPhysiology);
  calls.Add(Lane::kWork, *this, &StudyService::RunBatch);
}

void StudyService::Restore(const std::vector<store::SavedRecord>& records, std::map<std::string, absl::Status>& lost) {
  studies_.Restore(
      records, [this](const std::string& account) { return guard_.AccountOf(account); }, lost);
}

absl::Status StudyService::CheckOwns(const std::string& id, const access::Caller& caller) const {
  return guard_.CheckOwns(AccessGuard::Kind::kStudy, id, studies_.OwnerOf(id), caller);
}

grpc::Status StudyService::CreateStudy(grpc::CallbackServerContext* context, const v1::CreateStudyRequest* request,
                                       v1::CreateStudyResponse* response) {
  const auto caller = guard_.Admit(*context, *request);
  if (!caller.ok()) return ToGrpc(caller.status());
  auto study = studies_.Add(*request, caller->id());
  if (!study.ok()) return ToGrpc(study.status());
  *response->mutable_study() = *std::move(study);
  return grpc::Status::OK;
}

grpc::Status StudyService::WatchStudy(grpc::CallbackServerContext* context, const v1::WatchStudyRequest* request,
                                      ReplyStream<v1::WatchStudyResponse>* writer) {
  const auto caller = guard_.Admit(*context, *request);
  if (!caller.ok()) return ToGrpc(caller.status());
  if (absl::Status own = CheckOwns(request->study_id(), *caller); !own.ok()) return ToGrpc(own);
  v1::WatchStudyResponse response;
  return ToGrpc(studies_.Watch(
      request->study_id(), [&] { return context->IsCancelled(); },
      [&](v1::Study study) {
        *response.mutable_study() = std::move(study);
        return writer->Write(response);
      }));
}

grpc::Status StudyService::ListStudies(grpc::CallbackServerContext* context, const v1::ListStudiesRequest* request,
                                       v1::ListStudiesResponse* response) {
  const auto caller = guard_.Admit(*context, *request);
  if (!caller.ok()) return ToGrpc(caller.status());
  const auto visible = [&](const std::string& owner) { return guard_.MayUse(owner, *caller); };
  for (v1::Study& study : studies_.List(visible)) *response->add_studies() = std::move(study);
  return grpc::Status::OK;
}

grpc::Status StudyService::DeleteStudy(grpc::CallbackServerContext* context, const v1::DeleteStudyRequest* request,
                                       v1::DeleteStudyResponse*) {
  const auto caller = guard_.Admit(*context, *request);
  if (!caller.ok()) return ToGrpc(caller.status());
  if (absl::Status own = CheckOwns(request->study_id(), *caller); !own.ok()) return ToGrpc(own);
  return ToGrpc(studies_.Delete(request->study_id()));
}

grpc::Status StudyService::GetStudyPage(grpc::CallbackServerContext* context, const v1::GetStudyPageRequest* request,
                                        v1::GetStudyPageResponse* response) {
  const auto caller = guard_.Admit(*context, *request);
  if (!caller.ok()) return ToGrpc(caller.status());
  if (absl::Status own = CheckOwns(request->study_id(), *caller); !own.ok()) return ToGrpc(own);
  const auto seen = studies_.Wait(request->study_id(), 0, absl::ZeroDuration());
  if (!seen.ok()) return ToGrpc(seen.status());
  auto page = StudyPage(seen->message, web_root_);
  if (!page.ok()) return ToGrpc(page.status());
  response->set_html(*std::move(page));
  return grpc::Status::OK;
}

grpc::Status StudyService::CheckPhysiology(grpc::CallbackServerContext* context,
                                           const v1::CheckPhysiologyRequest* request,
                                           ReplyStream<v1::CheckPhysiologyResponse>* writer) {
  const auto caller = guard_.Admit(*context, *request);
  if (!caller.ok()) return ToGrpc(caller.status());
  const auto running = checks_.Take(guard_.ShareOf(*caller));
  if (!running.ok()) return ToGrpc(running.status());
  const auto model = models_.Get(request->source(), guard_.RequesterOf(*caller, *context));
  if (!model.ok()) return ToGrpc(model.status());
  v1::CheckPhysiologyResponse response;
  const std::vector<std::string> presets(request->presets().begin(), request->presets().end());
  const auto table = physiology::CheckPhysiology(**model, presets, [&](double done) {
    response.set_progress(done);
    return writer->Write(response) && !context->IsCancelled();
  });
  if (!table.ok()) return ToGrpc(table.status());
  *response.mutable_table() = *table;
  writer->Write(response);
  return grpc::Status::OK;
}

grpc::Status StudyService::RunBatch(grpc::CallbackServerContext* context, const v1::RunBatchRequest* request,
                                    ReplyStream<v1::RunBatchResponse>* writer) {
  const auto caller = guard_.Admit(*context, *request);
  if (!caller.ok()) return ToGrpc(caller.status());
  const auto running = batches_.Take(guard_.ShareOf(*caller));
  if (!running.ok()) return ToGrpc(running.status());
  const auto compile = [&](const v1::SceneSource& source) {
    return models_.Get(source, guard_.RequesterOf(*caller, *context));
  };
  const std::function<bool()> cancelled = [context] { return context->IsCancelled(); };
  const auto batch = study::Batch::Make(*request, compile, cancelled);
  if (!batch.ok()) return ToGrpc(batch.status());
  if (absl::Status status = writer->Reserve(batch->ResultBytes()); !status.ok()) return ToGrpc(status);
  v1::RunBatchResponse response;
  *response.mutable_header() = batch->Header();
  if (!writer->Write(response)) return ToGrpc(absl::CancelledError("the caller has gone"));
  const auto take = [&](v1::BatchResult result) {
    *response.mutable_result() = std::move(result);
    return writer->Write(response);
  };
  return ToGrpc(study::RunAll(*batch, take, cancelled));
}

}  // namespace phrenic::service
