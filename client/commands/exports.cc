// `phrenic exports`: the server's export jobs.
#include <iostream>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/cli/shared_options.h"
#include "client/commands/commands.h"
#include "client/connection/connection.h"
#include "client/connection/errors.h"
#include "client/files/motion_file.h"
#include "client/print/output.h"

namespace phrenic::client {
namespace {

struct GetExportOptions {
  std::string id, file;  // empty file: the export's own name
};

std::string StateOf(const v1::Export& job) {
  if (job.state() == v1::EXPORT_STATE_FAILED) return "failed: " + job.problem();
  if (job.state() == v1::EXPORT_STATE_DONE) return "done";
  return job.state() == v1::EXPORT_STATE_QUEUED ? "queued" : "running";
}

int ListExports(const Context& context) {
  const auto stub = v1::ExportService::NewStub(Connect(context));
  v1::ListExportsResponse response;
  const grpc::Status status =
      Call(context, *stub, &v1::ExportService::Stub::ListExports, v1::ListExportsRequest(), &response);
  if (!status.ok()) return Fail(context, status);
  Table table({"export", "session", "file", "done", "left [s]", "MB", "state"});
  for (const v1::Export& job : response.exports()) {
    table.Add({job.id(), job.session_id(), job.file_name(), absl::StrFormat("%.0f %%", 100 * job.progress()),
               job.has_seconds_left() ? absl::StrFormat("%.0f", job.seconds_left()) : "-",
               absl::StrFormat("%.1f", 1e-6 * static_cast<double>(job.bytes())), StateOf(job)});
  }
  PrintList(context, response, table);
  return kOk;
}

int GetExport(const Context& context, const GetExportOptions& options) {
  const auto stub = v1::ExportService::NewStub(Connect(context));
  v1::Export job;
  int code = WaitForExport(context, *stub, options.id, &job);
  const std::string file = options.file.empty() ? job.file_name() : options.file;
  if (code == kOk) code = DownloadExport(context, *stub, job, file, true);
  if (code != kOk) return code;
  if (context.json()) {
    std::cout << Json(job) << "\n";
  } else {
    std::cout << absl::StrFormat("%s: %d bytes\n", file, job.bytes());
  }
  return kOk;
}

int DeleteExport(const Context& context, const std::string& id) {
  const auto stub = v1::ExportService::NewStub(Connect(context));
  v1::DeleteExportRequest request;
  request.set_export_id(id);
  v1::DeleteExportResponse response;
  const grpc::Status status = Call(context, *stub, &v1::ExportService::Stub::DeleteExport, request, &response);
  return status.ok() ? kOk : Fail(context, status);
}

}  // namespace

CommandFunction SetUpExportsList(CLI::App&) { return ListExports; }

CommandFunction SetUpExportsGet(CLI::App& command) {
  const auto options = std::make_shared<GetExportOptions>();
  command.add_option("EXPORT", options->id)->required();
  command.add_option("FILE", options->file, "file to write (the export's own name, in this folder)");
  return Bind(&GetExport, options);
}

CommandFunction SetUpExportsDelete(CLI::App& command) {
  const auto id = std::make_shared<std::string>();
  command.add_option("EXPORT", *id)->required();
  return Bind(&DeleteExport, id);
}

}  // namespace phrenic::client
