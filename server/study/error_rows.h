// Rows of the error study: one integrator over a sequence of time steps, the Pareto front, and the advice.
#ifndef PHRENIC_SERVER_STUDY_ERROR_ROWS_H_
#define PHRENIC_SERVER_STUDY_ERROR_ROWS_H_

#include <vector>

#include "phrenic/v1/study.pb.h"
#include "server/study/trajectory.h"

namespace phrenic::study {

// The reference solution and its own error.
struct ReferenceSolution {
  std::vector<double> moments;  // times at which errors are measured [s]
  Trajectory trajectory;        // one state per moment
  double error_rms = 0;         // of the reference itself [m]
  double error_max = 0;         // [m]
};

// Appends one row per time step for the subject's integrator: error, CPU time per simulated second, and observed order
// of convergence log2(e(h)/e(h/2)). CANCELLED if `progress` returns false.
absl::Status AddIntegrator(const Subject& subject, const v1::ErrorStudy& study, const ReferenceSolution& solution,
                           const Progress& progress, v1::ErrorTable& table);
// Marks the Pareto front: rows that no other row beats in both RMS error and CPU time.
void MarkPareto(v1::ErrorTable& table);
// Returns a sentence that names the fastest integrator and step whose largest error is at most `target` [m].
std::string Advice(const v1::ErrorTable& table, double target);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_ERROR_ROWS_H_
