// `phrenic upload`: uploads a surface file for use in scenes.
#include <filesystem>
#include <iostream>

#include "client/cli/shared_options.h"
#include "client/commands/commands.h"
#include "client/connection/connection.h"
#include "client/connection/errors.h"
#include "client/files/whole_file.h"
#include "client/print/output.h"
#include "client/print/surface_report.h"
#include "client/terminal/progress.h"
#include "phrenic/v1/upload.grpc.pb.h"
#include "server/crypto/sha256.h"
#include "server/meshio/meshio.h"
#include "server/session/uploads.h"

namespace phrenic::client {
namespace {

struct UploadOptions {
  std::string file;
  double unit_mm = 1;  // length of the file's unit [mm]
};

// Sends the bytes that the server does not have yet.
grpc::Status SendBytes(const Context& context, v1::UploadService::Stub& stub, const std::string& bytes,
                       const v1::BeginUploadResponse& begun) {
  Progress progress("uploading", static_cast<double>(bytes.size()));
  v1::AddUploadChunkRequest request;
  request.set_upload_id(begun.upload_id());
  std::int64_t at = begun.received();
  while (at < static_cast<std::int64_t>(bytes.size())) {
    request.set_offset(at);
    request.set_chunk(bytes.substr(static_cast<std::size_t>(at), session::Uploads::kMostChunk));
    v1::AddUploadChunkResponse response;
    grpc::Status status = Call(context, stub, &v1::UploadService::Stub::AddUploadChunk, request, &response);
    if (!status.ok()) return status;
    at = response.received();
    progress.Update(static_cast<double>(at));
  }
  return grpc::Status::OK;
}

void Print(const Context& context, const v1::FinishUploadResponse& response) {
  if (context.json()) {
    std::cout << Json(response) << "\n";
    return;
  }
  std::cout << response.file().path() << "\n";
  if (response.has_report() && !response.report().repairs().empty()) PrintSurface(response.report(), std::cerr);
}

int Upload(const Context& context, const UploadOptions& options) {
  const auto bytes = ReadWhole(options.file, "the surface");
  if (!bytes.ok()) return Fail(bytes.status());
  const auto stub = v1::UploadService::NewStub(Connect(context));
  v1::BeginUploadRequest begin;
  begin.set_name(std::filesystem::path(options.file).filename().string());
  begin.set_size(static_cast<std::int64_t>(bytes->size()));
  begin.set_sha256(Sha256Hex(*bytes));
  v1::BeginUploadResponse begun;
  grpc::Status status = Call(context, *stub, &v1::UploadService::Stub::BeginUpload, begin, &begun);
  if (!status.ok()) return Fail(context, status);
  v1::FinishUploadResponse finished;
  *finished.mutable_file() = begun.file();
  if (!begun.upload_id().empty()) {
    v1::FinishUploadRequest finish;
    finish.set_upload_id(begun.upload_id());
    finish.set_unit_mm(options.unit_mm);
    status = SendBytes(context, *stub, *bytes, begun);
    if (status.ok()) status = Call(context, *stub, &v1::UploadService::Stub::FinishUpload, finish, &finished);
    if (!status.ok()) return Fail(context, status);
  }
  Print(context, finished);
  return kOk;
}

}  // namespace

CommandFunction SetUpUpload(CLI::App& command) {
  const auto options = std::make_shared<UploadOptions>();
  command.add_option("FILE", options->file, "a surface (" + meshio::Endings() + ")")->required();
  AddUnit(command, "--unit-mm", options->unit_mm, "FILE's");
  return Bind(&Upload, options);
}

}  // namespace phrenic::client
