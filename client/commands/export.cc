// `phrenic export`: a motion of a session as a file.
#include <iostream>

#include "absl/strings/str_format.h"
#include "client/commands/commands.h"
#include "client/files/motion_file.h"

namespace phrenic::client {
namespace {

int Detach(const Context& context, const v1::CreateExportRequest& request) {
  const auto stub = v1::ExportService::NewStub(Connect(context));
  v1::CreateExportResponse created;
  const grpc::Status status = Call(context, *stub, &v1::ExportService::Stub::CreateExport, request, &created);
  if (!status.ok()) return Fail(context, status);
  if (context.json()) {
    std::cout << Json(created.job()) << "\n";
  } else {
    std::cout << created.job().id() << "\n";
    std::cerr << "phrenic: fetch it by: phrenic exports get " << created.job().id() << "\n";
  }
  return kOk;
}

}  // namespace

int Export(const Context& context, const ExportOptions& options) {
  const auto request = MakeExportRequest(options.id, options.motion);
  if (!request.ok()) return Fail(request.status());
  if (options.detach) return Detach(context, *request);
  v1::ExportSummary summary;
  const int code = ExportToFile(context, Connect(context), *request, options.motion.file, &summary);
  if (code != kOk) return code;
  if (context.json()) {
    std::cout << Json(summary) << "\n";
  } else {
    std::cout << absl::StrFormat("%s: %d frames of %d vertices, %.3f s, %d bytes\n", options.motion.file,
                                 summary.frames(), summary.vertices(), summary.simulated_seconds(), summary.bytes());
  }
  return kOk;
}

}  // namespace phrenic::client
