// A motion made into a file: an export job watched, downloaded beside the file, checked, and put in its place whole.
#ifndef PHRENIC_CLIENT_FILES_MOTION_FILE_H_
#define PHRENIC_CLIENT_FILES_MOTION_FILE_H_

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/connection/connection.h"
#include "phrenic/v1/export.grpc.pb.h"

namespace phrenic::client {

// What a file's ending names: "msh" of "out.msh"; empty where it has none.
std::string FormatOf(const std::string& file);

// How a motion is recorded, as options say it.
struct MotionOptions {
  std::string file;
  std::optional<double> start;              // simulated time [s]
  std::optional<double> seconds;            // of the motion; not set: 8, or 0 for a format of one instant
  std::optional<double> frames_per_second;  // not set: the format's own
  int steps_per_frame = 0;                  // 0: by time
  bool displacements = false, positions = false;
  std::vector<std::string> bodies;
};

// The request for `session`. INVALID_ARGUMENT where the file's ending names no format.
absl::StatusOr<v1::CreateExportRequest> MakeExportRequest(const std::string& session, const MotionOptions& options);

// Creates the export, waits for it and downloads it to `file`; the server then forgets it. What breaks off is gone on
// with where it was; a file that is not whole is removed, and the export cancelled. A .pvd is unpacked: FILE.pvd, and
// the .vtp files in a folder FILE beside it. Gives the exit code; `summary` is set where it is kOk.
int ExportToFile(const Context& context, const std::shared_ptr<grpc::Channel>& channel,
                 const v1::CreateExportRequest& request, const std::string& file, v1::ExportSummary* summary);

// Waits for an export that is there, and shows a bar; gives the exit code, and the export as it ended.
int WatchToItsEnd(const Context& context, v1::ExportService::Stub& stub, const std::string& id, v1::Export* job);

// Downloads an export that is done; where `keep_part` holds, FILE.part stays when it breaks off and is gone on with.
int Download(const Context& context, v1::ExportService::Stub& stub, const v1::Export& job, const std::string& file,
             bool keep_part);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_FILES_MOTION_FILE_H_
