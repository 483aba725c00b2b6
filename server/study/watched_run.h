// A run that is expected to go wrong: how it ended, where, and how its kinetic energy went.
#ifndef PHRENIC_SERVER_STUDY_WATCHED_RUN_H_
#define PHRENIC_SERVER_STUDY_WATCHED_RUN_H_

#include "server/study/context.h"

namespace phrenic::study {

struct WatchedRun {
  absl::Status status;         // of the last step: OUT_OF_RANGE where it diverged, ABORTED where it stopped
  v1::Divergence divergence;   // set where the status is an error
  bool cut = false;            // out of CPU time
  double simulated_s = 0;      // [s]
  double largest_kinetic = 0;  // [J]
  double late_kinetic = 0;     // the largest of the second half [J]
  State last;                  // not to be trusted where the status is an error
};

// Steps of `dt` from `start` until `seconds` are over. `each` is told of every state, the start too. CANCELLED as soon
// as `progress` says so, which is asked every few steps.
using EachState = std::function<void(const State&)>;
absl::StatusOr<WatchedRun> Watch(const Subject& subject, const State& start, double seconds, double dt,
                                 double most_cpu_s, const Progress& progress, const EachState& each = nullptr);

// Of the vertices that forces move [J]; v 3 x n [m/s].
double KineticEnergy(const Model& model, const Points& v);

// "vertex 3 of sheet, by springs:sheet"
std::string Where(const v1::Divergence& divergence);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_WATCHED_RUN_H_
