// A motion as a file: a copy of a session's state, stepped on and recorded.
#ifndef PHRENIC_SERVER_SESSION_EXPORTER_H_
#define PHRENIC_SERVER_SESSION_EXPORTER_H_

#include <functional>
#include <memory>
#include <string_view>

#include "absl/status/statusor.h"
#include "phrenic/v1/export.pb.h"
#include "server/session/session.h"

namespace phrenic::session {

// Where an export goes. An error of either call stops it and becomes its own.
struct ExportSink {
  // The next bytes of the file; may block for as long as the receiver takes.
  std::function<absl::Status(std::string_view bytes)> chunk;
  // Simulated time recorded so far [s].
  std::function<absl::Status(double seconds)> progress;
};

// Steps `fork` on for request.seconds and records its first state and one state every 1/frames_per_second, each at the
// first step that reaches its time. The request is in range. INVALID_ARGUMENT names the field where there is no such
// format or body, OUT_OF_RANGE tells where the motion diverged. Runs on the caller's thread.
absl::StatusOr<v1::ExportSummary> ExportMotion(const v1::ExportMotionRequest& request,
                                               const std::shared_ptr<const Model>& model, Session::Fork fork,
                                               const ExportSink& sink);

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_EXPORTER_H_
