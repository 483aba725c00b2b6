#include "server/study/cost_trials.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "absl/strings/str_format.h"
#include "server/mechanics/step.h"

namespace phrenic::study {
namespace {

constexpr int kLook = 512;             // steps between two looks at the clock and the caller
constexpr int kWarm = 8;               // steps before the clock starts
constexpr double kWorthTiming = 5e-3;  // of a trial, at least [s]
constexpr int kMostTurns = 1000;       // of a trial

// Where a subject begins, and what its integrator needs.
struct Stand {
  State start;
  Workspace work;
  double clock = 0;  // what the clock itself takes [s]
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
double TakeSteps(Timing& timing, int steps, Stand& stand, State& state) {
  const Subject& subject = timing.subject;
  const double dt = subject.parameters.time_step();
  const double begin = ThreadCpuSeconds();
  for (int i = 0; i < steps; ++i) {
    const absl::Status stepped = Step(*subject.model, subject.parameters, dt, state, stand.work);
    if (stepped.ok()) continue;
    timing.problem =
        absl::StrFormat("starts again: %s at %.3g s", absl::IsAborted(stepped) ? "stopped" : "diverged", state.time);
    state = stand.start;
  }
  return std::max(0.0, ThreadCpuSeconds() - begin - stand.clock);
}

// One turn from rest [s].
absl::StatusOr<double> TakeTurn(Timing& timing, Stand& stand, State& state, const std::function<bool()>& go_on) {
  state = stand.start;
  TakeSteps(timing, std::min(kWarm, timing.steps), stand, state);
  state = stand.start;
  double spent = 0;
  for (int done = 0; done < timing.steps; done += kLook) {
    if (!go_on()) return Cancelled();
    spent += TakeSteps(timing, std::min(kLook, timing.steps - done), stand, state);
  }
  return spent;
}

// Turns of a trial.
int TurnsFor(double quickest) {
  if (!(quickest > 0)) return kMostTurns;
  return std::clamp(static_cast<int>(std::ceil(kWorthTiming / quickest)), 1, kMostTurns);
}

}  // namespace

absl::Status TimeInTurn(std::vector<Timing>& timings, int trials, const Progress& progress) {
  std::vector<Stand> stands;
  const double clock = ClockCost();
  for (const Timing& timing : timings) {
    stands.push_back({timing.subject.model->InitialState(), timing.subject.model->MakeWorkspace(), clock});
  }
  State state;  // one for all: those of one size step in the same memory, and differ by their models alone
  double done = 0;
  // The first round is to warm up, and says how many turns a trial takes.
  const auto round = [&](double to, std::vector<double>& spent) {
    const double from = done;
    for (size_t i = 0; i < timings.size(); ++i) {
      done = from + (to - from) * static_cast<double>(i) / static_cast<double>(timings.size());
      const auto turn = TakeTurn(timings[i], stands[i], state, [&] { return progress(done, "timing steps in turn"); });
      if (!turn.ok()) return turn.status();
      spent[i] += *turn;
    }
    done = to;
    return absl::OkStatus();
  };
  std::vector<double> warm(timings.size());
  const double share = 1.0 / (trials + 1);
  if (absl::Status status = round(share, warm); !status.ok()) return status;
  const int turns = warm.empty() ? 0 : TurnsFor(*std::min_element(warm.begin(), warm.end()));
  for (int trial = 1; trial <= trials; ++trial) {
    std::vector<double> spent(timings.size());
    for (int turn = 1; turn <= turns; ++turn) {
      const double to = share * (trial + static_cast<double>(turn) / turns);
      if (absl::Status status = round(to, spent); !status.ok()) return status;
    }
    for (size_t i = 0; i < timings.size(); ++i) timings[i].step_s.push_back(spent[i] / turns / timings[i].steps);
  }
  return absl::OkStatus();
}

double Median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

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
  for (size_t i = 0; i < std::min(a.step_s.size(), b.step_s.size()); ++i) {
    if (b.step_s[i] > 0) ratios.push_back(a.step_s[i] / b.step_s[i]);
  }
  return Median(std::move(ratios));
}

}  // namespace phrenic::study
