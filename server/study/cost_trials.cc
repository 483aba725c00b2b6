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

constexpr int kWarmUp = 8;              // steps before the first trial
constexpr double kMinTrialTime = 5e-3;  // [s]
constexpr int kMaxTurns = 1000;         // of a trial
constexpr double kMinPartTime = 1e-3;   // [s]; short, so that drift affects all subjects alike
constexpr double kMinPartSteps = 16;
constexpr int kFewestSteps = 16;  // of a trial that the budget cuts short

// The run of one subject.
struct TrialRun {
  State start, state;
  Workspace work;
  double clock = 0;     // cost of reading the clock [s]
  double spent = 0;     // CPU time in this trial [s]
  double of_steps = 0;  // number of steps in this trial
};

// Median difference of two consecutive clock readings [s].
double ClockCost() {
  std::vector<double> nothing(101);
  for (double& seconds : nothing) {
    const double begin = ThreadCpuSeconds();
    seconds = ThreadCpuSeconds() - begin;
  }
  return Median(std::move(nothing));
}

// Takes steps and returns their CPU time [s]. Restarts from the start if a step fails.
double TakeSteps(Timing& timing, int steps, TrialRun& run) {
  const Subject& subject = timing.subject;
  const double dt = subject.parameters.time_step();
  const double begin = ThreadCpuSeconds();
  for (int i = 0; i < steps; ++i) {
    const absl::Status stepped = Step(*subject.model, subject.parameters, dt, run.state, run.work);
    if (stepped.ok()) continue;
    timing.problem =
        absl::StrFormat("restarted: %s at %.3g s", absl::IsAborted(stepped) ? "stopped" : "diverged", run.state.time);
    run.state = run.start;
  }
  return std::max(0.0, ThreadCpuSeconds() - begin - run.clock);
}

// Runs part number `part` of `parts` of a turn. Its first step is not timed, unless it is the only one.
void TakePart(Timing& timing, int part, int parts, TrialRun& run) {
  if (part == 0) run.state = run.start;
  const auto at = [&](int edge) { return static_cast<int>(static_cast<std::int64_t>(timing.steps) * edge / parts); };
  int steps = at(part + 1) - at(part);
  if (steps > 1) {
    TakeSteps(timing, 1, run);
    --steps;
  }
  const double spent = TakeSteps(timing, steps, run);
  timing.part_s.push_back(steps > 0 ? spent / steps : 0);
  run.spent += spent;
  run.of_steps += steps;
}

// How a trial is divided.
struct Plan {
  int turns = 1;  // repetitions of all steps, each from rest
  int parts = 1;  // per turn
};

Plan PlanFor(const std::vector<Timing>& timings, const std::vector<double>& step_s) {
  double quickest = HUGE_VAL, fewest = HUGE_VAL;
  for (size_t i = 0; i < timings.size(); ++i) {
    quickest = std::min(quickest, step_s[i] * timings[i].steps);
    fewest = std::min<double>(fewest, timings[i].steps);
  }
  const double turns = std::ceil(kMinTrialTime / std::max(quickest, kMinTrialTime / kMaxTurns));
  const double parts = std::min(quickest / kMinPartTime, fewest / kMinPartSteps);
  return {.turns = static_cast<int>(turns), .parts = std::max(1, static_cast<int>(parts))};
}

// CPU time of a trial of all subjects [s].
double TrialTime(const std::vector<Timing>& timings, const std::vector<double>& step_s, const Plan& plan) {
  double sum = 0;
  for (size_t i = 0; i < timings.size(); ++i) sum += plan.turns * timings[i].steps * step_s[i];
  return sum;
}

// Takes fewer steps in a trial, so that one fits. Returns the fraction of the steps.
double ShortenTrials(std::vector<Timing>& timings, double trial_s, double most_seconds) {
  if (trial_s <= most_seconds) return 1;
  const double fraction = most_seconds / trial_s;
  for (Timing& timing : timings) timing.steps = std::max(kFewestSteps, static_cast<int>(fraction * timing.steps));
  return fraction;
}

// Prepares the runs and estimates the CPU time per step of each [s].
absl::StatusOr<std::vector<TrialRun>> WarmUp(std::vector<Timing>& timings, const Progress& progress,
                                             std::vector<double>& step_s) {
  std::vector<TrialRun> runs;
  const double clock = ClockCost();
  for (Timing& timing : timings) {
    if (!progress(0, "warming up")) return Cancelled();
    const State start = timing.subject.model->InitialState();
    runs.push_back({start, start, timing.subject.model->MakeWorkspace(), clock});
    TakeSteps(timing, 1, runs.back());
    step_s.push_back(TakeSteps(timing, kWarmUp, runs.back()) / kWarmUp);
  }
  return runs;
}

// Makes the runs of the next trial: memory at other addresses, as the runs before are still there, and other models.
absl::Status Renew(std::vector<Timing>& timings, std::vector<TrialRun>& runs) {
  for (size_t i = 0; i < timings.size(); ++i) {
    if (timings[i].again) {
      auto subject = timings[i].again();
      if (!subject.ok()) return subject.status();
      timings[i].subject = *std::move(subject);
    }
    const Model& model = *timings[i].subject.model;
    const State start = model.InitialState();
    runs[i] = TrialRun{start, start, model.MakeWorkspace(), runs[i].clock};
    TakeSteps(timings[i], kWarmUp, runs[i]);
  }
  return absl::OkStatus();
}

// Returns the median ratio over the parts [from, to).
double MedianRatioOf(const Timing& a, const Timing& b, size_t from, size_t to) {
  std::vector<double> ratios;
  for (size_t i = from; i < to; ++i) {
    if (b.part_s[i] > 0) ratios.push_back(a.part_s[i] / b.part_s[i]);
  }
  return Median(std::move(ratios));
}

}  // namespace

absl::Status TimeInterleaved(std::vector<Timing>& timings, int trials, double most_seconds, const std::string& what,
                             CostBudget& budget, const Progress& progress) {
  if (timings.empty()) return absl::OkStatus();
  const double began = budget.spent();
  std::vector<double> warm;
  auto runs = WarmUp(timings, progress, warm);
  if (!runs.ok()) return runs.status();
  const double trial_s = TrialTime(timings, warm, PlanFor(timings, warm));
  const double fraction = ShortenTrials(timings, trial_s, most_seconds);
  if (fraction < 1)
    budget.Cut(absl::StrFormat("%s: trials are cut to %.0f %% of their steps", what, 100 * fraction), trials * trial_s);
  const Plan plan = PlanFor(timings, warm);
  const int rounds = plan.turns * plan.parts;
  for (int trial = 0; trial < trials; ++trial) {
    const double spent = budget.spent() - began;
    if (trial > 0 && spent * (trial + 1) / trial > most_seconds) {
      budget.Cut(absl::StrFormat("%s: %d of %d trials were made", what, trial, trials), spent * trials / trial);
      break;
    }
    if (trial > 0) {
      if (absl::Status status = Renew(timings, *runs); !status.ok()) return status;
    }
    for (int round = 0; round < rounds; ++round) {
      const double done = (trial + static_cast<double>(round) / rounds) / trials;
      for (size_t i = 0; i < timings.size(); ++i) {
        if (!progress(done, "timing steps in turn")) return Cancelled();
        TakePart(timings[i], round % plan.parts, plan.parts, (*runs)[i]);
      }
    }
    for (size_t i = 0; i < timings.size(); ++i) {
      const TrialRun& run = (*runs)[i];
      timings[i].step_s.push_back(run.spent / run.of_steps);
    }
  }
  return absl::OkStatus();
}

void AddTrials(const std::string& variant, const Timing& timing, v1::CostTable& table) {
  for (size_t trial = 0; trial < timing.step_s.size(); ++trial) {
    v1::TrialRow& row = *table.add_trials();
    row.set_variant(variant);
    row.set_vertices(timing.subject.model->report.simulated_vertices());
    row.set_trial(static_cast<int64_t>(trial) + 1);
    row.set_cpu_us_per_step(1e6 * timing.step_s[trial]);
  }
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
  return MedianRatioOf(a, b, 0, std::min(a.part_s.size(), b.part_s.size()));
}

std::vector<double> MedianRatioOfTrials(const Timing& a, const Timing& b) {
  const size_t trials = std::min(a.step_s.size(), b.step_s.size());
  const size_t parts = trials > 0 ? std::min(a.part_s.size(), b.part_s.size()) / trials : 0;
  std::vector<double> ratios;
  for (size_t trial = 0; trial < trials; ++trial) {
    ratios.push_back(MedianRatioOf(a, b, trial * parts, (trial + 1) * parts));
  }
  return ratios;
}

}  // namespace phrenic::study
