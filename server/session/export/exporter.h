// A motion as a file: a copy of a session's state, stepped on and recorded.
#ifndef PHRENIC_SERVER_SESSION_EXPORT_EXPORTER_H_
#define PHRENIC_SERVER_SESSION_EXPORT_EXPORTER_H_

#include <functional>
#include <memory>

#include "absl/status/statusor.h"
#include "phrenic/v1/export.pb.h"
#include "server/session/export/export_file.h"
#include "server/session/export/export_plan.h"
#include "server/session/session.h"

namespace phrenic::session {

// Hears of an export about five times a second: the share that is done, 0 to 1, and the simulated time that is recorded
// [s]. An error ends the export and becomes its own.
using ExportProgress = std::function<absl::Status(double share, double recorded_seconds)>;

// Steps `fork` on to plan.start, then for plan.seconds, and records the first state there and one state every
// 1/frames_per_second, each at the first step that reaches its time, or one every steps_per_frame steps. OUT_OF_RANGE
// tells where the motion diverged; RESOURCE_EXHAUSTED that the disk is full. Runs on the caller's thread.
absl::StatusOr<v1::ExportSummary> ExportMotion(const ExportPlan& plan, const std::shared_ptr<const Model>& model,
                                               Session::Fork fork, ExportFile& file, const ExportProgress& progress);

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_EXPORT_EXPORTER_H_
