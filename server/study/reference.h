// Reference solutions by an independent adaptive ODE solver, against which errors are measured.
#ifndef PHRENIC_SERVER_STUDY_REFERENCE_H_
#define PHRENIC_SERVER_STUDY_REFERENCE_H_

#include <vector>

#include "phrenic/v1/study_results.pb.h"
#include "server/study/trajectory.h"

namespace phrenic::study {

// Solves x' = v, v' = Acceleration from rest with SUNDIALS' CVODE (Adams-Moulton of variable order and step,
// fixed-point iteration: Hindmarsh et al., ACM TOMS 31:363, 2005). The local error is below `tolerance` [m] for each
// coordinate, and below `tolerance` times the fastest eigenfrequency, clamped to 1/s to 10/s, for each velocity. None
// of Phrenic's integrators is involved. Stiff tissue needs steps as short as an explicit integrator. Returns one state
// per moment [s]; `report` gets method, tolerance, number of evaluations and CPU time. Errors: UNIMPLEMENTED if a
// constraint has no smooth equation, FAILED_PRECONDITION if no vertex is free, ABORTED if CVODE fails, CANCELLED if
// `progress` returns false. Uses one thread.
absl::StatusOr<Trajectory> SolveReference(const Subject& subject, const std::vector<double>& moments, double tolerance,
                                          const Progress& progress, v1::Reference& report);

// The same from the initial state `start` at time 0.
absl::StatusOr<Trajectory> SolveReferenceFrom(const Subject& subject, const State& start,
                                              const std::vector<double>& moments, double tolerance,
                                              const Progress& progress, v1::Reference& report);

// Solves twice, with `tolerance` and with a tenth of it. Returns the second solution; `report` gets the distance of the
// two as the error of the reference [mm].
absl::StatusOr<Trajectory> ConfirmedReference(const Subject& subject, const std::vector<double>& moments,
                                              double tolerance, const Progress& progress, v1::Reference& report);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_REFERENCE_H_
