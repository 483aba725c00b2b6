// An export's request made definite: what is recorded, when and how, and the room that it takes.
#ifndef PHRENIC_SERVER_SESSION_EXPORT_EXPORT_PLAN_H_
#define PHRENIC_SERVER_SESSION_EXPORT_EXPORT_PLAN_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "phrenic/v1/export.pb.h"
#include "server/mechanics/model.h"
#include "server/record/recorder.h"
#include "server/session/session.h"

namespace phrenic::session {

struct ExportPlan {
  record::Format format;
  record::Values values = record::Values::kPositions;
  std::string file_stem;
  std::string spool_folder;
  std::vector<int> bodies;           // of the model
  double start = 0, seconds = 0;     // [s]
  double frames_per_second = 0;      // where steps_per_frame is 0
  std::int64_t steps_per_frame = 0;  // 0: by time
  std::int64_t vertices = 0;
  std::int64_t bytes = 0;  // an estimate of what file and spool take together
};

// The request is in range. INVALID_ARGUMENT names the field where there is no such format or body, or where the format
// cannot do what is asked; RESOURCE_EXHAUSTED where the spool folder's disk has no room for the plan's bytes.
absl::StatusOr<ExportPlan> PlanExport(const v1::CreateExportRequest& request, const Model& model,
                                      const Session::Fork& fork, const std::string& spool_folder);

// The columns beside the positions: the probes' places [mm], then the measures.
std::vector<record::Column> PoseMatricesOf(const Model& model);
std::vector<double> NumbersAt(const Model& model, const v1::Parameters& parameters, const State& state);

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_EXPORT_EXPORT_PLAN_H_
