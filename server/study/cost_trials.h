// Measures CPU time per step of several subjects in interleaved trials, so that load and drift affect all alike.
#ifndef PHRENIC_SERVER_STUDY_COST_TRIALS_H_
#define PHRENIC_SERVER_STUDY_COST_TRIALS_H_

#include <functional>
#include <string>
#include <vector>

#include "phrenic/v1/study_results.pb.h"
#include "server/study/cost_budget.h"
#include "server/study/trajectory.h"

namespace phrenic::study {

// A subject and its measured times.
struct Timing {
  Subject subject;
  // Compiles the subject again; empty: all trials run the same model. Where a step takes less than a microsecond, its
  // time depends on the addresses of the model: trials then differ as repeated studies do.
  std::function<absl::StatusOr<Subject>()> again;
  int steps = 0;               // least number of steps per trial
  std::vector<double> step_s;  // mean CPU time per step of each trial [s]
  std::vector<double> part_s;  // and of each part of each trial [s]
  std::string problem;         // why a run was restarted; empty if none was
};

// Runs `trials` trials of each subject from rest, in round-robin order over short parts of a trial; each trial has a
// state and workspace of its own. The steps of a
// trial are repeated until the fastest subject takes at least 5 ms. Takes fewer steps, then fewer trials, but at least
// one, if they do not fit into `most_seconds` of wall time, and notes it as `what`. CANCELLED if `progress` returns
// false. Uses one thread.
absl::Status TimeInterleaved(std::vector<Timing>& timings, int trials, double most_seconds, const std::string& what,
                             CostBudget& budget, const Progress& progress);

// Appends the timing's trials.
void AddTrials(const std::string& variant, const Timing& timing, v1::CostTable& table);

// Returns the median; 0 if there are no values.
double Median(std::vector<double> values);
// Returns the interquartile mean: finer than the resolution of the clock and robust against interruptions.
double MiddleMean(std::vector<double> values);
// Returns (largest - smallest) / median; 0 for a single value.
double Spread(const std::vector<double>& values);
// Returns the median over parts of the ratio of a's time to b's in the same part.
double MedianRatio(const Timing& a, const Timing& b);
// Returns the same of each trial: how far the ratio repeats.
std::vector<double> MedianRatioOfTrials(const Timing& a, const Timing& b);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_COST_TRIALS_H_
