// The cost study: CPU time of each part of a scene, and proof that a part that is left out costs nothing.
#ifndef PHRENIC_SERVER_STUDY_COST_H_
#define PHRENIC_SERVER_STUDY_COST_H_

#include "phrenic/v1/study.pb.h"
#include "server/study/context.h"

namespace phrenic::study {

// Measures the CPU time per step (of this thread, under the subject's parameters, from rest, in interleaved trials):
// of the whole scene and of the scene without each of its parts (cost_variants.h); of the stages of a step
// (cost_stages.h); of the mesh sizes of the thesis; and as a function of the number of vertices (cost_sizes.h).
// Requires: every field of the request's study is set. Errors: those of the compile step; CANCELLED if `progress`
// returns false. Uses one thread.
absl::StatusOr<v1::CostTable> StudyCost(const v1::CreateStudyRequest& request, const Subject& subject,
                                        const Compiler& compile, const Progress& progress);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_COST_H_
