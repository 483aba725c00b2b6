// A motion downloaded to a file: written beside it, checked, and put in its place when it is whole.
#ifndef PHRENIC_CLIENT_MOTION_FILE_H_
#define PHRENIC_CLIENT_MOTION_FILE_H_

#include <memory>
#include <string>

#include "client/connection.h"
#include "phrenic/v1/export.pb.h"

namespace phrenic::client {

// The format that a file's ending names: "msh" of "out.msh"; empty where it has none.
std::string FormatOf(const std::string& file);

// Runs ExportMotion and writes FILE.part, which becomes FILE when its size and SHA-256 are those of the summary; a part
// that is not whole is removed. Gives the exit code; `summary` is set where it is kOk.
int DownloadMotion(const Context& context, const std::shared_ptr<grpc::Channel>& channel,
                   const v1::ExportMotionRequest& request, const std::string& file, v1::ExportSummary* summary);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_MOTION_FILE_H_
