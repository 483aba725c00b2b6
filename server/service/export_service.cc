#include "server/service/export_service.h"

#include <algorithm>
#include <string>

#include "absl/strings/str_cat.h"
#include "server/service/calls/status.h"
#include "server/session/export/export_catalogue.h"

namespace phrenic::service {
namespace {

constexpr std::int64_t kChunk = 128 << 10;  // [bytes]

v1::ExportValues ToProto(record::Values values) {
  return values == record::Values::kPositions ? v1::EXPORT_VALUES_POSITIONS : v1::EXPORT_VALUES_DISPLACEMENTS;
}

}  // namespace

void ExportService::AddTo(CallTable& calls) {
  calls.Add(Lane::kQuick, *this, &ExportService::ListFormats);
  calls.Add(Lane::kSession, *this, &ExportService::CreateExport);
  calls.Add(Lane::kWatch, *this, &ExportService::WatchExport);
  calls.Add(Lane::kQuick, *this, &ExportService::ListExports);
  calls.Add(Lane::kSession, *this, &ExportService::DeleteExport);
  calls.Add(Lane::kStream, *this, &ExportService::DownloadExport);
}

absl::Status ExportService::CheckOwns(const std::string& id, const access::Caller& caller) const {
  return guard_.CheckOwns(AccessGuard::Kind::kExport, id, exports_.OwnerOf(id), caller);
}

grpc::Status ExportService::ListFormats(grpc::CallbackServerContext* context, const v1::ListFormatsRequest* request,
                                        v1::ListFormatsResponse* response) {
  const auto caller = guard_.Admit(*context, *request);
  if (!caller.ok()) return ToGrpc(caller.status());
  for (const record::Format& format : session::ExportFormats()) {
    v1::FileFormat& listed = *response->add_formats();
    listed.set_name(format.name);
    listed.set_description(format.description);
    listed.set_ending(format.ending);
    listed.set_instant(format.instant);
    for (const record::Values values : format.values) listed.add_values(ToProto(values));
    listed.set_frames_a_breath(format.frames_a_breath);
    listed.set_numbers_only(format.numbers_only);
    listed.set_page(format.page);
  }
  return grpc::Status::OK;
}

grpc::Status ExportService::CreateExport(grpc::CallbackServerContext* context, const v1::CreateExportRequest* request,
                                         v1::CreateExportResponse* response) {
  const auto caller = guard_.Admit(*context, *request);
  if (!caller.ok()) return ToGrpc(caller.status());
  const auto session = table_.Find(request->session_id());
  if (!session.ok()) return ToGrpc(session.status());
  auto fork = (*session)->MakeFork();
  if (!fork.ok()) return ToGrpc(fork.status());
  auto job =
      exports_.Add(*request, {(*session)->shared_model(), *std::move(fork), (*session)->surfaces(), caller->id()});
  if (!job.ok()) return ToGrpc(job.status());
  *response->mutable_job() = *std::move(job);
  return grpc::Status::OK;
}

grpc::Status ExportService::WatchExport(grpc::CallbackServerContext* context, const v1::WatchExportRequest* request,
                                        ReplyStream<v1::WatchExportResponse>* writer) {
  const auto caller = guard_.Admit(*context, *request);
  if (!caller.ok()) return ToGrpc(caller.status());
  if (absl::Status own = CheckOwns(request->export_id(), *caller); !own.ok()) return ToGrpc(own);
  v1::WatchExportResponse response;
  return ToGrpc(exports_.Watch(
      request->export_id(), [&] { return context->IsCancelled(); },
      [&](v1::Export job) {
        *response.mutable_job() = std::move(job);
        return writer->Write(response);
      }));
}

grpc::Status ExportService::ListExports(grpc::CallbackServerContext* context, const v1::ListExportsRequest* request,
                                        v1::ListExportsResponse* response) {
  const auto caller = guard_.Admit(*context, *request);
  if (!caller.ok()) return ToGrpc(caller.status());
  const auto visible = [&](const std::string& owner) { return guard_.MayUse(owner, *caller); };
  for (v1::Export& job : exports_.List(visible)) *response->add_exports() = std::move(job);
  return grpc::Status::OK;
}

grpc::Status ExportService::DeleteExport(grpc::CallbackServerContext* context, const v1::DeleteExportRequest* request,
                                         v1::DeleteExportResponse*) {
  const auto caller = guard_.Admit(*context, *request);
  if (!caller.ok()) return ToGrpc(caller.status());
  if (absl::Status own = CheckOwns(request->export_id(), *caller); !own.ok()) return ToGrpc(own);
  return ToGrpc(exports_.Delete(request->export_id()));
}

absl::Status ExportService::Download(const v1::DownloadExportRequest& request,
                                     ReplyStream<v1::DownloadExportResponse>& writer) const {
  const auto file = exports_.File(request.export_id());
  if (!file.ok()) return file.status();
  const std::int64_t size = (*file)->size();
  if (request.offset() < 0 || request.offset() > size) {
    return absl::OutOfRangeError(
        absl::StrCat("offset: ", request.offset(), " is outside the file of ", size, " bytes"));
  }
  v1::DownloadExportResponse response;
  for (std::int64_t at = request.offset(); at < size;) {
    const std::int64_t count = std::min(kChunk, size - at);
    response.mutable_chunk()->resize(static_cast<std::size_t>(count));
    absl::Status status = (*file)->Read(at, response.mutable_chunk()->data(), static_cast<std::size_t>(count));
    if (!status.ok()) return status;
    if (!writer.Write(response)) return absl::CancelledError("the client disconnected during the download");
    at += count;
  }
  return absl::OkStatus();
}

grpc::Status ExportService::DownloadExport(grpc::CallbackServerContext* context,
                                           const v1::DownloadExportRequest* request,
                                           ReplyStream<v1::DownloadExportResponse>* writer) {
  const auto caller = guard_.Admit(*context, *request);
  if (!caller.ok()) return ToGrpc(caller.status());
  if (absl::Status own = CheckOwns(request->export_id(), *caller); !own.ok()) return ToGrpc(own);
  return ToGrpc(Download(*request, *writer));
}

}  // namespace phrenic::service
