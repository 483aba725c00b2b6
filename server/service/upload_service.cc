#include "server/service/upload_service.h"

#include "server/compare/inspection.h"
#include "server/meshio/formats.h"
#include "server/service/calls/status.h"

namespace phrenic::service {
namespace {

void Fill(const session::Uploads::File& file, v1::UploadedFile& filled) {
  filled.set_path(file.path());
  filled.set_name(file.name);
  filled.set_size(file.size);
}

}  // namespace

void UploadService::AddTo(CallTable& calls) {
  calls.Add(Lane::kQuick, *this, &UploadService::ListSurfaceFormats);
  calls.Add(Lane::kSession, *this, &UploadService::BeginUpload);
  calls.Add(Lane::kSession, *this, &UploadService::AddUploadChunk);
  calls.Add(Lane::kWork, *this, &UploadService::FinishUpload);
  calls.Add(Lane::kQuick, *this, &UploadService::ListUploads);
  calls.Add(Lane::kSession, *this, &UploadService::DeleteUpload);
}

grpc::Status UploadService::ListSurfaceFormats(grpc::CallbackServerContext* context,
                                               const v1::ListSurfaceFormatsRequest* request,
                                               v1::ListSurfaceFormatsResponse* response) {
  const auto caller = guard_.Admit(*context, *request);
  if (!caller.ok()) return ToGrpc(caller.status());
  for (const meshio::Format& format : meshio::Formats()) {
    v1::SurfaceFormat& listed = *response->add_formats();
    listed.set_ending(std::string(format.ending));
    listed.set_written(format.write != nullptr);
  }
  response->set_most_bytes(limits_.upload_bytes);
  return grpc::Status::OK;
}

grpc::Status UploadService::BeginUpload(grpc::CallbackServerContext* context, const v1::BeginUploadRequest* request,
                                        v1::BeginUploadResponse* response) {
  const auto caller = guard_.Admit(*context, *request);
  if (!caller.ok()) return ToGrpc(caller.status());
  const auto kind =
      request->kind() == v1::UPLOAD_KIND_LABELS ? session::Uploads::Kind::kLabels : session::Uploads::Kind::kSurface;
  const auto begun =
      uploads_.Begin(guard_.RequesterOf(*caller, *context), request->name(), request->size(), request->sha256(), kind);
  if (!begun.ok()) return ToGrpc(begun.status());
  response->set_upload_id(begun->id);
  response->set_received(begun->received);
  if (!begun->id.empty()) return grpc::Status::OK;
  // The caller has uploaded the file before.
  Fill(begun->file, *response->mutable_file());
  return grpc::Status::OK;
}

grpc::Status UploadService::AddUploadChunk(grpc::CallbackServerContext* context,
                                           const v1::AddUploadChunkRequest* request,
                                           v1::AddUploadChunkResponse* response) {
  const auto caller = guard_.Admit(*context, *request);
  if (!caller.ok()) return ToGrpc(caller.status());
  const auto received =
      uploads_.Add(guard_.RequesterOf(*caller, *context), request->upload_id(), request->offset(), request->chunk());
  if (!received.ok()) return ToGrpc(received.status());
  response->set_received(*received);
  return grpc::Status::OK;
}

grpc::Status UploadService::FinishUpload(grpc::CallbackServerContext* context, const v1::FinishUploadRequest* request,
                                         v1::FinishUploadResponse* response) {
  const auto caller = guard_.Admit(*context, *request);
  if (!caller.ok()) return ToGrpc(caller.status());
  const double unit_mm = request->has_unit_mm() ? request->unit_mm() : 1;
  const auto finished = uploads_.Finish(guard_.RequesterOf(*caller, *context), request->upload_id(), unit_mm);
  if (!finished.ok()) return ToGrpc(finished.status());
  Fill(finished->file, *response->mutable_file());
  if (finished->surface.has_value()) {
    *response->mutable_report() = compare::Inspect(finished->file.name, *finished->surface, unit_mm);
  }
  return grpc::Status::OK;
}

grpc::Status UploadService::ListUploads(grpc::CallbackServerContext* context, const v1::ListUploadsRequest* request,
                                        v1::ListUploadsResponse* response) {
  const auto caller = guard_.Admit(*context, *request);
  if (!caller.ok()) return ToGrpc(caller.status());
  for (const session::Uploads::File& file : uploads_.List(guard_.RequesterOf(*caller, *context))) {
    Fill(file, *response->add_files());
  }
  return grpc::Status::OK;
}

grpc::Status UploadService::DeleteUpload(grpc::CallbackServerContext* context, const v1::DeleteUploadRequest* request,
                                         v1::DeleteUploadResponse*) {
  const auto caller = guard_.Admit(*context, *request);
  if (!caller.ok()) return ToGrpc(caller.status());
  return ToGrpc(uploads_.Delete(guard_.RequesterOf(*caller, *context), request->path()));
}

}  // namespace phrenic::service
