#include "client/files/motion_file.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>

#include "absl/strings/str_cat.h"
#include "client/connection/connection.h"
#include "client/connection/errors.h"
#include "client/files/part_file.h"
#include "client/files/unpack.h"
#include "client/terminal/progress.h"
#include "server/record/spool_file.h"
#include "server/session/export/export_catalogue.h"

namespace phrenic::client {
namespace {

constexpr double kSeconds = 8;  // default length of a motion
constexpr char kArchive[] = "zip";
constexpr double kMegabyte = 1e6;

// Cancels and deletes the export. Not part of the interruptible calls, so that Ctrl-C does not stop it.
void ForgetExport(v1::ExportService::Stub& stub, const std::string& id) {
  v1::DeleteExportRequest request;
  request.set_export_id(id);
  v1::DeleteExportResponse response;
  grpc::ClientContext call;
  call.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(2));
  (void)stub.DeleteExport(&call, request, &response);
}

// Downloads from the end of the part file to the end of the export. `written` receives the first error of writing.
grpc::Status Receive(const Context& context, v1::ExportService::Stub& stub, const v1::Export& job, PartFile& part,
                     absl::Status& written, absl::FunctionRef<void()> on_chunk) {
  v1::DownloadExportRequest request;
  request.set_export_id(job.id());
  request.set_offset(part.bytes());
  grpc::ClientContext call;
  const Interruption::Scope scope(*context.interruption, call);
  const auto stream = stub.DownloadExport(&call, request);
  v1::DownloadExportResponse response;
  while (written.ok() && stream->Read(&response)) {
    written = part.Write(response.chunk());
    on_chunk();
  }
  if (!written.ok()) call.TryCancel();
  return stream->Finish();
}

// Renames the part file and unpacks it if FILE is one of several.
absl::Status FinishDownload(const v1::Export& job, const std::string& file, PartFile& part) {
  const bool unpacked = FormatOf(file) != kArchive && FormatOf(job.file_name()) == kArchive;
  const std::string archive_file = unpacked ? file + "." + kArchive : file;
  if (absl::Status status = part.Finish(job.summary().sha256()); !status.ok() || !unpacked) return status;
  absl::Status status = Unpack(archive_file, std::filesystem::path(file).parent_path().string());
  std::error_code ignored;
  std::filesystem::remove(archive_file, ignored);
  return status;
}

// Checks that the folder is writable before the server starts to work.
absl::Status CheckFolder(const std::string& file) {
  const std::filesystem::path folder = std::filesystem::absolute(file).parent_path();
  if (::access(folder.c_str(), W_OK) == 0) return absl::OkStatus();
  return absl::NotFoundError(
      absl::StrCat("cannot write ", file, ": check that its folder exists and that you may write to it"));
}

}  // namespace

std::string FormatOf(const std::string& file) {
  const size_t dot = file.find_last_of('.');
  return dot == std::string::npos || file.find('/', dot) != std::string::npos ? "" : file.substr(dot + 1);
}

absl::StatusOr<v1::CreateExportRequest> MakeExportRequest(const std::string& session, const MotionOptions& options) {
  v1::CreateExportRequest request;
  request.set_session_id(session);
  request.set_format(FormatOf(options.file));
  const auto format = record::FindFormat(session::ExportFormats(), request.format());
  if (!format.ok()) return format.status();
  // The files in an archive name each other, so they need the final name.
  if (format->ending == kArchive) request.set_file_stem(std::filesystem::path(options.file).stem().string());
  request.set_seconds(options.seconds.value_or(format->instant || format->page ? 0 : kSeconds));
  if (options.start) request.set_start(*options.start);
  if (options.frames_per_second) request.set_frames_per_second(*options.frames_per_second);
  if (options.steps_per_frame > 0) request.set_steps_per_frame(options.steps_per_frame);
  if (options.displacements) request.set_values(v1::EXPORT_VALUES_DISPLACEMENTS);
  if (options.positions) request.set_values(v1::EXPORT_VALUES_POSITIONS);
  for (const std::string& body : options.bodies) request.add_bodies(body);
  return request;
}

int WaitForExport(const Context& context, v1::ExportService::Stub& stub, const std::string& id, v1::Export* job) {
  v1::WatchExportRequest request;
  request.set_export_id(id);
  grpc::Status status;
  {
    Progress progress("recording", 1);
    status = StreamWithReconnect(context, [&](OnReceived received) {
      grpc::ClientContext call;
      const Interruption::Scope scope(*context.interruption, call);
      const auto stream = stub.WatchExport(&call, request);
      for (v1::WatchExportResponse response; stream->Read(&response);) {
        received();
        *job = response.job();
        progress.SetDetail(
            absl::StrCat(static_cast<std::int64_t>(static_cast<double>(job->bytes()) / kMegabyte), " MB"));
        progress.Update(job->progress());
      }
      return stream->Finish();
    });
  }
  if (!status.ok()) return Fail(context, status);
  if (job->state() == v1::EXPORT_STATE_DONE) return kOk;
  return Fail(
      absl::AbortedError(job->problem().empty() ? "the export failed and the server gave no reason" : job->problem()));
}

int DownloadExport(const Context& context, v1::ExportService::Stub& stub, const v1::Export& job,
                   const std::string& file, bool keep_part) {
  const std::filesystem::path folder = std::filesystem::absolute(file).parent_path();
  const absl::Status room = record::CheckRoom(folder.string(), job.bytes());
  if (absl::IsResourceExhausted(room)) return Fail(room);
  const bool unpacked = FormatOf(file) != kArchive && FormatOf(job.file_name()) == kArchive;
  PartFile part(unpacked ? file + "." + kArchive : file, keep_part);
  Progress progress("downloading", static_cast<double>(job.bytes()));
  absl::Status written;
  const grpc::Status status = StreamWithReconnect(context, [&](OnReceived received) {
    return Receive(context, stub, job, part, written, [&] {
      received();
      progress.Update(static_cast<double>(part.bytes()));
    });
  });
  if (!written.ok()) return Fail(written);
  if (!status.ok()) return Fail(context, status);
  const absl::Status finished = FinishDownload(job, file, part);
  return finished.ok() ? kOk : Fail(finished);
}

int ExportToFile(const Context& context, const std::shared_ptr<grpc::Channel>& channel,
                 const v1::CreateExportRequest& request, const std::string& file, v1::ExportSummary* summary) {
  if (absl::Status status = CheckFolder(file); !status.ok()) return Fail(status);
  const auto stub = v1::ExportService::NewStub(channel);
  v1::CreateExportResponse created;
  const grpc::Status status = Call(context, *stub, &v1::ExportService::Stub::CreateExport, request, &created);
  if (!status.ok()) return Fail(context, status);
  v1::Export job;
  int code = WaitForExport(context, *stub, created.job().id(), &job);
  if (code == kOk) code = DownloadExport(context, *stub, job, file, false);
  ForgetExport(*stub, created.job().id());
  *summary = job.summary();
  return code;
}

}  // namespace phrenic::client
