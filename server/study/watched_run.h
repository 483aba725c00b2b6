// A run that may diverge: how and where it ended, and its kinetic energy.
#ifndef PHRENIC_SERVER_STUDY_WATCHED_RUN_H_
#define PHRENIC_SERVER_STUDY_WATCHED_RUN_H_

#include "server/study/context.h"

namespace phrenic::study {

// The outcome of a run.
struct WatchedRun {
  absl::Status status;         // of the last step: OUT_OF_RANGE if it diverged, ABORTED if error control stopped it
  v1::Divergence divergence;   // set if the status is an error
  bool cut = false;            // true if the run exceeded its CPU time
  double simulated_s = 0;      // simulated time [s]
  double largest_kinetic = 0;  // largest kinetic energy [J]
  double late_kinetic = 0;     // the same over the second half of the run [J]
  State last;                  // the last state; not valid if the status is an error
};

// Called with every state of a run.
using EachState = std::function<void(const State&)>;

// Takes steps of `dt` [s] from `start` for `seconds` of simulated time. Calls `each` with every state, the start
// included. If a step fails, Diagnose names the vertex and force. Ends with `cut` after the CPU time `most_cpu_s` [s].
// CANCELLED if `progress`, called every kCheckInterval steps, returns false. Uses one thread.
absl::StatusOr<WatchedRun> Watch(const Subject& subject, const State& start, double seconds, double dt,
                                 double most_cpu_s, const Progress& progress, const EachState& each = nullptr);

// Returns the kinetic energy of the free vertices [J]; `v` are velocities, 3 x n [m/s].
double KineticEnergy(const Model& model, const Points& v);

// Returns the location and force of a divergence: "vertex 3 of sheet, by springs:sheet".
std::string Where(const v1::Divergence& divergence);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_WATCHED_RUN_H_
