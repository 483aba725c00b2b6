#include "server/study/cost_trials.h"

#include <algorithm>
#include <boost/math/statistics/univariate_statistics.hpp>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

#include "absl/strings/str_format.h"
#include "server/mechanics/step/step.h"
#include "server/schema/thread_cpu.h"

namespace phrenic::study {
namespace {

constexpr int kWarm = 8;               // steps before the first trial
constexpr double kWorthTiming = 5e-3;  // of a trial, at least [s]
constexpr int kMostTurns = 1000;       // of a trial
constexpr double kPart = 1e-3;         // of a turn, at least [s]: so short that drift hits all alike ...
constexpr double kStepsOfAPart = 16;   // ... and at least so many steps

// Where a subject begins, where it is, and what its integrator needs.
struct Stand {
  State start, state;
  Workspace work;
  double clock = 0;     // what the clock itself takes [s]
  double spent = 0;     // in this trial [s]
  double of_steps = 0;  // steps that it was spent on
};

// What two readings of the clock show with nothing between them [s].
double ClockCost() {
  std::vector<double> nothing(101);
  for (double& seconds : nothing) {
    const double begin = ThreadCpuSeconds();
    seconds = ThreadCpuSeconds() - begin;
  }
  return Median(std::move(nothing));
}

// Takes steps, from the start again after one that failed; the CPU time of the steps [s].
double TakeSteps(Timing& timing, int steps, Stand& stand) {
  const Subject& subject = timing.subject;
  const double dt = subject.parameters.time_step();
  const double begin = ThreadCpuSeconds();
  for (int i = 0; i < steps; ++i) {
    const absl::Status stepped = Step(*subject.model, subject.parameters, dt, stand.state, stand.work);
    if (stepped.ok()) continue;
    timing.problem = absl::StrFormat("starts again: %s at %.3g s", absl::IsAborted(stepped) ? "stopped" : "diverged",
                                     stand.state.time);
    stand.state = stand.start;
  }
  return std::max(0.0, ThreadCpuSeconds() - begin - stand.clock);
}

// One part of `parts` of a turn. Its first step is to warm up, where there are more.
void TakePart(Timing& timing, int part, int parts, Stand& stand) {
  if (part == 0) stand.state = stand.start;
  const auto at = [&](int edge) { return static_cast<int>(static_cast<std::int64_t>(timing.steps) * edge / parts); };
  int steps = at(part + 1) - at(part);
  if (steps > 1) {
    TakeSteps(timing, 1, stand);
    --steps;
  }
  const double spent = TakeSteps(timing, steps, stand);
  timing.part_s.push_back(steps > 0 ? spent / steps : 0);
  stand.spent += spent;
  stand.of_steps += steps;
}

// How a trial is cut up.
struct Plan {
  int turns = 1;  // each of all steps, from rest
  int parts = 1;  // of a turn
};

Plan PlanFor(const std::vector<Timing>& timings, const std::vector<double>& step_s) {
  double quickest = HUGE_VAL, fewest = HUGE_VAL;
  for (size_t i = 0; i < timings.size(); ++i) {
    quickest = std::min(quickest, step_s[i] * timings[i].steps);
    fewest = std::min<double>(fewest, timings[i].steps);
  }
  const double turns = std::ceil(kWorthTiming / std::max(quickest, kWorthTiming / kMostTurns));
  const double parts = std::min(quickest / kPart, fewest / kStepsOfAPart);
  return {.turns = static_cast<int>(turns), .parts = std::max(1, static_cast<int>(parts))};
}

// From rest, with what each takes for a step [s].
absl::StatusOr<std::vector<Stand>> WarmUp(std::vector<Timing>& timings, const Progress& progress,
                                          std::vector<double>& step_s) {
  std::vector<Stand> stands;
  const double clock = ClockCost();
  for (Timing& timing : timings) {
    if (!progress(0, "warming up")) return Cancelled();
    const State start = timing.subject.model->InitialState();
    stands.push_back({start, start, timing.subject.model->MakeWorkspace(), clock});
    TakeSteps(timing, 1, stands.back());
    step_s.push_back(TakeSteps(timing, kWarm, stands.back()) / kWarm);
  }
  return stands;
}

}  // namespace

absl::Status TimeInTurn(std::vector<Timing>& timings, int trials, const Progress& progress) {
  if (timings.empty()) return absl::OkStatus();
  std::vector<double> warm;
  auto stands = WarmUp(timings, progress, warm);
  if (!stands.ok()) return stands.status();
  const Plan plan = PlanFor(timings, warm);
  const int rounds = plan.turns * plan.parts;
  for (int trial = 0; trial < trials; ++trial) {
    for (int round = 0; round < rounds; ++round) {
      const double done = (trial + static_cast<double>(round) / rounds) / trials;
      for (size_t i = 0; i < timings.size(); ++i) {
        if (!progress(done, "timing steps in turn")) return Cancelled();
        TakePart(timings[i], round % plan.parts, plan.parts, (*stands)[i]);
      }
    }
    for (size_t i = 0; i < timings.size(); ++i) {
      Stand& stand = (*stands)[i];
      timings[i].step_s.push_back(stand.spent / stand.of_steps);
      stand.spent = stand.of_steps = 0;
    }
  }
  return absl::OkStatus();
}

double Median(std::vector<double> values) { return values.empty() ? 0 : boost::math::statistics::median(values); }

double MiddleMean(std::vector<double> values) {
  if (values.size() < 4) return Median(std::move(values));
  std::sort(values.begin(), values.end());
  const auto quarter = static_cast<std::ptrdiff_t>(values.size() / 4);
  return std::accumulate(values.begin() + quarter, values.end() - quarter, 0.0) /
         static_cast<double>(values.end() - values.begin() - 2 * quarter);
}

double Spread(const std::vector<double>& values) {
  const double median = Median(values);
  if (!(median > 0)) return 0;
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return (*most - *least) / median;
}

double MedianRatio(const Timing& a, const Timing& b) {
  std::vector<double> ratios;
  for (size_t i = 0; i < std::min(a.part_s.size(), b.part_s.size()); ++i) {
    if (b.part_s[i] > 0) ratios.push_back(a.part_s[i] / b.part_s[i]);
  }
  return Median(std::move(ratios));
}

}  // namespace phrenic::study
