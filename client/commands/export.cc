#include <iostream>

#include "absl/strings/str_format.h"
#include "client/commands.h"
#include "client/motion_file.h"

namespace phrenic::client {

int Export(const Context& context, const ExportOptions& options) {
  v1::ExportMotionRequest request;
  request.set_session_id(options.id);
  request.set_format(FormatOf(options.file));
  request.set_seconds(options.seconds);
  request.set_frames_per_second(options.frames_per_second);
  for (const std::string& body : options.bodies) request.add_bodies(body);
  v1::ExportSummary summary;
  const int code = DownloadMotion(context, Connect(context), request, options.file, &summary);
  if (code != kOk) return code;
  if (context.json()) {
    std::cout << Json(summary) << "\n";
  } else {
    std::cout << absl::StrFormat("%s: %d frames of %d vertices, %.3f s, %d bytes\n", options.file, summary.frames(),
                                 summary.vertices(), summary.simulated_seconds(), summary.bytes());
  }
  return kOk;
}

}  // namespace phrenic::client
