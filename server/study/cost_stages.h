// Where the time of a step goes, from inside: a copy of the model whose elements hold a clock each. Steps of other
// models know nothing of it.
#ifndef PHRENIC_SERVER_STUDY_COST_STAGES_H_
#define PHRENIC_SERVER_STUDY_COST_STAGES_H_

#include "phrenic/v1/study.pb.h"
#include "server/study/context.h"

namespace phrenic::study {

// Appends a row for each thing that each element does in a step ("force" of "springs:muscle", "velocities" of
// "rigid-links:diaphragm"), one for what remains ("integrator") and one for the whole step. Wall time, means of
// the middle half of `steps` steps, less what the clocks take themselves. CANCELLED as soon as `progress` says so.
absl::Status AddStages(const Subject& subject, int steps, const Progress& progress, v1::CostTable& table);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_COST_STAGES_H_
