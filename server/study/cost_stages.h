// Profiles a step by stages with a copy of the model whose elements measure their own time (timed_model.h).
#ifndef PHRENIC_SERVER_STUDY_COST_STAGES_H_
#define PHRENIC_SERVER_STUDY_COST_STAGES_H_

#include "phrenic/v1/study.pb.h"
#include "server/study/context.h"

namespace phrenic::study {

// Appends a row per stage of each element ("force" of "springs:muscle", "velocities" of "rigid-links:diaphragm"), one
// for the remainder ("integrator") and one for the whole step. Times are wall times: interquartile means over `steps`
// steps, minus the cost of the clocks. The whole step is timed without clocks inside. CANCELLED if `progress` returns
// false.
absl::Status AddStages(const Subject& subject, int steps, const Progress& progress, v1::CostTable& table);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_COST_STAGES_H_
