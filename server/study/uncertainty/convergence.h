// How far the outputs of a scene depend on time step, mesh and integrator.
#ifndef PHRENIC_SERVER_STUDY_UNCERTAINTY_CONVERGENCE_H_
#define PHRENIC_SERVER_STUDY_UNCERTAINTY_CONVERGENCE_H_

#include "phrenic/v1/study.pb.h"
#include "server/study/context.h"

namespace phrenic::study {

// Runs the scene as it is, with halved time steps, with other resolutions of its generated bodies and with other
// integrators, one change at a time. A finer mesh has the time step that its stability limit demands, unless the
// request or the scene sets it. Requires: the defaults of the study are set. Errors: those of Outputs::Make, RunAll and
// `compile`.
absl::StatusOr<v1::ConvergenceTable> StudyConvergence(const v1::CreateStudyRequest& request, const Subject& subject,
                                                      const Compiler& compile, const Progress& progress);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_UNCERTAINTY_CONVERGENCE_H_
