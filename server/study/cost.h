// What each part of a scene costs, and that what is left out costs nothing.
#ifndef PHRENIC_SERVER_STUDY_COST_H_
#define PHRENIC_SERVER_STUDY_COST_H_

#include "phrenic/v1/study.pb.h"
#include "server/study/context.h"

namespace phrenic::study {

// Times the scene whole and without each of its parts (CPU time of this thread, under the subject's parameters, from
// rest, in trials that take turns), each part left out by the compile step against a scene that never named it, the
// stages of a step, the sizes of the thesis and the growth with the number of vertices. Every field of `request`'s
// study must be set. Errors: those of the compile step; CANCELLED as soon as `progress` says so.
absl::StatusOr<v1::CostTable> StudyCost(const v1::CreateStudyRequest& request, const Subject& subject,
                                        const Compiler& compile, const Progress& progress);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_COST_H_
