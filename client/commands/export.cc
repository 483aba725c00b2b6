// `phrenic export`: writes a session's motion to a file.
#include <iostream>

#include "absl/strings/str_format.h"
#include "client/cli/shared_options.h"
#include "client/commands/commands.h"
#include "client/connection/connection.h"
#include "client/connection/errors.h"
#include "client/files/motion_file.h"
#include "client/print/output.h"
#include "client/print/print_session.h"

namespace phrenic::client {
namespace {

struct ExportOptions {
  std::string id;
  MotionOptions motion;
  bool detach = false;  // true: do not wait for the export
};

// Creates the export and prints its id.
int ExportDetached(const Context& context, const v1::CreateExportRequest& request) {
  const auto stub = v1::ExportService::NewStub(Connect(context));
  v1::CreateExportResponse created;
  const grpc::Status status = Call(context, *stub, &v1::ExportService::Stub::CreateExport, request, &created);
  if (!status.ok()) return Fail(context, status);
  if (context.json()) {
    std::cout << Json(created.job()) << "\n";
  } else {
    std::cout << created.job().id() << "\n";
    std::cerr << "phrenic: to download it: phrenic exports get " << created.job().id() << "\n";
  }
  return kOk;
}

int Export(const Context& context, const ExportOptions& options) {
  const auto request = MakeExportRequest(options.id, options.motion);
  if (!request.ok()) return Fail(request.status());
  if (options.detach) return ExportDetached(context, *request);
  v1::ExportSummary summary;
  const int code = ExportToFile(context, Connect(context), *request, options.motion.file, &summary);
  if (code != kOk) return code;
  std::cerr << WarningLines(summary.warnings(), "phrenic: ");
  if (context.json()) {
    std::cout << Json(summary) << "\n";
  } else {
    std::cout << absl::StrFormat("%s: %d frames of %d vertices, %.3f s, %d bytes\n", options.motion.file,
                                 summary.frames(), summary.vertices(), summary.simulated_seconds(), summary.bytes());
  }
  return kOk;
}

}  // namespace

CommandFunction SetUpExport(CLI::App& command) {
  const auto options = std::make_shared<ExportOptions>();
  AddSession(command, options->id);
  command.add_option("FILE", options->motion.file, "file to write; its ending sets the format" + ExportEndings())
      ->check(ExportFile())
      ->required();
  command.add_option("--seconds", options->motion.seconds,
                     "simulated time to record [s] (8; .html: one breath; 0 for one instant)");
  AddMotion(command, options->motion);
  command.add_flag("--detach", options->detach, "print the export's id and let it run on the server");
  return Bind(&Export, options);
}

}  // namespace phrenic::client
