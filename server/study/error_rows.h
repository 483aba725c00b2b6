// The rows of the error study: one integrator's ladder, and what is read off all of them.
#ifndef PHRENIC_SERVER_STUDY_ERROR_ROWS_H_
#define PHRENIC_SERVER_STUDY_ERROR_ROWS_H_

#include <vector>

#include "phrenic/v1/study.pb.h"
#include "server/study/trajectory.h"

namespace phrenic::study {

// What every ladder is held against.
struct Yardstick {
  std::vector<double> moments;
  Trajectory reference;
  double reference_rms = 0;  // what the reference errs by [m]
  double reference_max = 0;  // [m]
};

// Appends the rows of the subject's own integrator. CANCELLED as soon as `progress` says so.
absl::Status AddLadder(const Subject& subject, const v1::ErrorStudy& study, const Yardstick& yardstick,
                       const Progress& progress, v1::ErrorTable& table);
// Marks the rows that no other row is both faster and better than.
void MarkPareto(v1::ErrorTable& table);
// The sentence: for that error [m] use this integrator at this step.
std::string Advice(const v1::ErrorTable& table, double target);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_ERROR_ROWS_H_
