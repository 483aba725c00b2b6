// What an export records, when and how, and how much disk space it needs.
#ifndef PHRENIC_SERVER_SESSION_EXPORT_EXPORT_PLAN_H_
#define PHRENIC_SERVER_SESSION_EXPORT_EXPORT_PLAN_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "phrenic/v1/export.pb.h"
#include "server/mechanics/model.h"
#include "server/record/recorder.h"
#include "server/session/run.h"

namespace phrenic::session {

// Plain data.
struct ExportPlan {
  record::Format format;
  record::Values values = record::Values::kPositions;
  std::string file_stem;             // of the name that a download gets, without the ending
  std::string spool_folder;          // for the file and the recorder's spool
  std::string page_template;         // path of the viewer's offline.html, for a page
  std::vector<int> bodies;           // indices into the model's bodies
  double start = 0, seconds = 0;     // [s]
  double frames_per_second = 0;      // if steps_per_frame is 0
  std::int64_t steps_per_frame = 0;  // 0: frames_per_second counts
  std::int64_t vertices = 0;         // of all bodies
  std::int64_t bytes = 0;            // estimate for file and spool together
};

// Makes the plan of a request whose fields are in range, for a run that starts at `fork`. INVALID_ARGUMENT names the
// field if there is no such format or body, or if the format cannot do what is requested; RESOURCE_EXHAUSTED if the
// disk of the spool folder has no room for plan.bytes; NOT_FOUND if the format is a page and there is no
// `page_template`. A page without start and length is of the first whole breath that begins from now on, and at least
// one breath after the start of the run. Thread-safe.
absl::StatusOr<ExportPlan> PlanExport(const v1::CreateExportRequest& request, const Model& model, const Fork& fork,
                                      const std::string& spool_folder, const std::string& page_template = "");

// Returns the columns of a format of numbers: the coordinates of the probes [mm], then the measures.
std::vector<record::Column> ColumnsOf(const Model& model);
// Returns their values, one per column. Each has the unit of its column.
std::vector<double> NumbersAt(const Model& model, const v1::Parameters& parameters, const State& state);

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_EXPORT_EXPORT_PLAN_H_
