// Whether a run at a time step leaves the same run at a much shorter step.
#ifndef PHRENIC_SERVER_STUDY_LEAVING_H_
#define PHRENIC_SERVER_STUDY_LEAVING_H_

#include <string>

#include "server/study/watched_run.h"

namespace phrenic::study {

// The run at a short step, which others are judged by.
struct ShortStepRun {
  State start;
  double seconds = 0;   // simulated time [s]; shorter than asked for if the CPU budget was used up
  double kinetic = 0;   // largest kinetic energy [J]
  Points end;           // positions at the end, 3 x n [m]
  std::string problem;  // where and why it failed; empty if it did not
};

// Runs `seconds` of simulated time from `start` at steps of `dt` [s]. CANCELLED if `progress` returns false.
absl::StatusOr<ShortStepRun> RunShortSteps(const Subject& subject, const State& start, double seconds, double dt,
                                           double most_cpu_s, const Progress& progress);

// The result of a trial; kCut if it ran out of CPU time.
enum class Trial { kStays, kLeaves, kCut };

// Runs the same time at steps of `dt` [s]. It leaves if a step fails, if its largest kinetic energy exceeds both 10
// times that of the run at short steps and `growth` times that of the start, or if a vertex ends further from its place
// there than the size of the scene. Errors of integration, which shift phases but add no energy, do not count.
// CANCELLED if `progress` returns false. Requires: `short_steps` has no problem.
absl::StatusOr<Trial> TryStep(const Subject& subject, const ShortStepRun& short_steps, double dt, double growth,
                              double most_cpu_s, const Progress& progress);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_LEAVING_H_
