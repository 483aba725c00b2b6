// Reference solutions where no ODE solver can make one: constraints that are inequalities.
#ifndef PHRENIC_SERVER_STUDY_REFINED_REFERENCE_H_
#define PHRENIC_SERVER_STUDY_REFINED_REFERENCE_H_

#include <vector>

#include "phrenic/v1/study_results.pb.h"
#include "server/study/trajectory.h"

namespace phrenic::study {

// True if every constraint of the model has a smooth equation, so that SolveReference can solve it.
bool IsSmooth(const Model& model);

// Solves from rest by velocity Verlet, and halves the step until two successive runs differ by less than `tolerance`
// [m] at every vertex or the next run would take too long. Returns the last run, one state per moment [s]; `report`
// gets the step, and the distance of the last two runs, which is the error of the last where the method is of first
// order. It shows how a run converges with its step, not that the equations are right: no other code is involved.
// Errors: ABORTED if fewer than two runs end, CANCELLED if `progress` returns false. Uses one thread.
absl::StatusOr<Trajectory> RefinedReference(const Subject& subject, const std::vector<double>& moments,
                                            double tolerance, const Progress& progress, v1::Reference& report);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_REFINED_REFERENCE_H_
