// The independent solution that errors are measured against.
#ifndef PHRENIC_SERVER_STUDY_REFERENCE_H_
#define PHRENIC_SERVER_STUDY_REFERENCE_H_

#include <vector>

#include "phrenic/v1/study_results.pb.h"
#include "server/study/trajectory.h"

namespace phrenic::study {

// Solves x' = v, v' = Acceleration by SUNDIALS' CVODE (Adams-Moulton of variable order and step, fixed-point iteration:
// Hindmarsh et al., ACM TOMS 31:363, 2005), with the local error of every single coordinate below `tolerance` [m], of
// every velocity below `tolerance` times the fastest eigenfrequency, but at least 1/s and at most 10/s: the slow
// vertices of a scene with fast ones are held to theirs. None of Phrenic's integrators takes
// part. Where tissue is very stiff, its steps are as short as theirs. UNIMPLEMENTED where no smooth equation describes
// the model, ABORTED where CVODE finds no next step, CANCELLED as soon as `progress` says so.
absl::StatusOr<Trajectory> SolveReference(const Subject& subject, const std::vector<double>& moments, double tolerance,
                                          const Progress& progress, v1::Reference& report);

// The same from another start than rest, at its time 0.
absl::StatusOr<Trajectory> SolveReferenceFrom(const Subject& subject, const State& start,
                                              const std::vector<double>& moments, double tolerance,
                                              const Progress& progress, v1::Reference& report);

// The same twice, the second time at a tenth of the tolerance: the better one, and in `report` how far they are apart,
// which is what the reference errs by.
absl::StatusOr<Trajectory> ConfirmedReference(const Subject& subject, const std::vector<double>& moments,
                                              double tolerance, const Progress& progress, v1::Reference& report);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_REFERENCE_H_
