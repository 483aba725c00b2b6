// How long steps take: several subjects in turn, round after round, so that whatever slows the machine slows all alike.
#ifndef PHRENIC_SERVER_STUDY_COST_TRIALS_H_
#define PHRENIC_SERVER_STUDY_COST_TRIALS_H_

#include <string>
#include <vector>

#include "server/study/trajectory.h"

namespace phrenic::study {

// One subject that is timed, from rest, time after time.
struct Timing {
  Subject subject;
  int steps = 0;               // of a trial, at least
  std::vector<double> step_s;  // CPU time of a step in each trial [s]
  std::vector<double> part_s;  // and in each part of each [s]
  std::string problem;         // why a turn ended early, after which it began anew; empty where none did
};

// Each trial takes every subject through its steps from rest, a short part of each in turn, and again while all steps
// of the quickest are too few for the clock. CANCELLED as soon as `progress` says so.
absl::Status TimeInTurn(std::vector<Timing>& timings, int trials, const Progress& progress);

double Median(std::vector<double> values);
// The mean of the middle half: finer than the clock's ticks, and deaf to interruptions.
double MiddleMean(std::vector<double> values);
// (Largest - smallest) / median; 0 for a single one.
double Spread(const std::vector<double>& values);
// The median over the parts of a's time over b's in the same part.
double MedianRatio(const Timing& a, const Timing& b);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_COST_TRIALS_H_
