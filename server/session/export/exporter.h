// Steps a copy of a session's state and records its motion in a file.
#ifndef PHRENIC_SERVER_SESSION_EXPORT_EXPORTER_H_
#define PHRENIC_SERVER_SESSION_EXPORT_EXPORTER_H_

#include <functional>
#include <memory>

#include "absl/status/statusor.h"
#include "phrenic/v1/export.pb.h"
#include "server/session/export/export_file.h"
#include "server/session/export/export_plan.h"
#include "server/session/run.h"

namespace phrenic::session {

// Called about five times a second with the share of the work that is done, 0 to 1, and the simulated time recorded so
// far [s]. An error ends the export, which returns it.
using ExportProgress = std::function<absl::Status(double share, double recorded_seconds)>;

// Steps `fork` to plan.start, then for plan.seconds, on the caller's thread. Records the first state there, and then
// one state every 1/frames_per_second, each at the first step that reaches its time, or one every steps_per_frame
// steps. OUT_OF_RANGE tells where the motion diverged; RESOURCE_EXHAUSTED that the disk is full. `share` counts the
// writing from a spool as half of the work. The session of the fork is not touched. The errors of the recorder, the
// file and `progress`. Thread-safe for different files.
absl::StatusOr<v1::ExportSummary> ExportMotion(const ExportPlan& plan, const std::shared_ptr<const Model>& model,
                                               Fork fork, ExportFile& file, const ExportProgress& progress);

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_EXPORT_EXPORTER_H_
