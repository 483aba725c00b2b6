// Exports a session's motion to a file: creates an export job on the server, waits for it and downloads its file.
#ifndef PHRENIC_CLIENT_FILES_MOTION_FILE_H_
#define PHRENIC_CLIENT_FILES_MOTION_FILE_H_

#include <grpcpp/channel.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/connection/context.h"
#include "phrenic/v1/export.grpc.pb.h"

namespace phrenic::client {

// Returns the file's ending without the dot: "msh" for "out.msh"; empty if there is none.
std::string FormatOf(const std::string& file);

// The options of a recording.
struct MotionOptions {
  std::string file;
  std::optional<double> start;                    // simulated time [s]
  std::optional<double> seconds;                  // simulated time [s]; not set: 8, or 0 for a format of one instant
  std::optional<double> frames_per_second;        // of simulated time; not set: the format's default
  int steps_per_frame = 0;                        // 0: use frames_per_second
  bool displacements = false, positions = false;  // what .msh and .pvd store
  std::vector<std::string> bodies;                // empty: all deformable ones
};

// Returns the request for `session`. INVALID_ARGUMENT if the file's ending names no export format.
absl::StatusOr<v1::CreateExportRequest> MakeExportRequest(const std::string& session, const MotionOptions& options);

// Creates an export, waits for it, downloads it to `file` and deletes it on the server. Resumes after a broken
// connection. After a failure the export is cancelled and no incomplete file is left. A .pvd export becomes FILE.pvd
// and a folder FILE of .vtp files. Returns the exit code and prints errors; sets `summary` if the code is kOk.
int ExportToFile(const Context& context, const std::shared_ptr<grpc::Channel>& channel,
                 const v1::CreateExportRequest& request, const std::string& file, v1::ExportSummary* summary);

// Waits for an export and shows a progress bar. Returns the exit code; `job` receives the export's last state.
int WaitForExport(const Context& context, v1::ExportService::Stub& stub, const std::string& id, v1::Export* job);

// Downloads a finished export. If `keep_part` is true, an incomplete FILE.part is kept and resumed. Returns the exit
// code.
int DownloadExport(const Context& context, v1::ExportService::Stub& stub, const v1::Export& job,
                   const std::string& file, bool keep_part);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_FILES_MOTION_FILE_H_
