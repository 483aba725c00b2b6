#include "server/study/cost_stages.h"

#include <algorithm>
#include <chrono>

#include "server/mechanics/step/step.h"
#include "server/study/cost_trials.h"
#include "server/study/timed_model.h"

namespace phrenic::study {
namespace {

constexpr int kBlock = 16;             // steps without clocks, then as many with clocks, so that caches are warm
constexpr int kMaxTimedSteps = 20000;  // upper bound of stored times

// A run that is timed step by step.
struct TimedRun {
  const Model& model;
  State state;
  Workspace work;

  explicit TimedRun(const Model& of, const State& start) : model(of), state(start), work(of.MakeWorkspace()) {}

  // Takes a step and returns its wall time [s]; restarts from `start` if it fails.
  double Take(const v1::Parameters& parameters, const State& start) {
    const auto begin = std::chrono::steady_clock::now();
    const absl::Status status = Step(model, parameters, parameters.time_step(), state, work);
    const double took = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (!status.ok()) state = start;
    return took;
  }
};

// Times of the stages and of whole steps, one entry per step [s].
struct Times {
  std::vector<std::vector<double>> stages;
  std::vector<double> whole;
  std::vector<long> calls;
};

void Collect(double clock, Stages& stages, Times& times) {
  for (size_t i = 0; i < stages.size(); ++i) {
    times.stages[i].push_back(stages[i].seconds - stages[i].parts * clock);
    times.calls[i] += stages[i].calls;
    stages[i].seconds = 0;
    stages[i].calls = 0;
    stages[i].parts = 0;
  }
}

// Alternates blocks of steps of two equal runs, one without clocks inside and one with them.
absl::StatusOr<Times> Watch(const Subject& subject, int steps, const Progress& progress, Stages& stages) {
  const std::shared_ptr<const Model> timed_model = Timed(*subject.model, stages);
  const State start = subject.model->InitialState();
  TimedRun plain(*subject.model, start), timed(*timed_model, start);
  const double clock = ClockCost();
  Times times;
  times.stages.resize(stages.size());
  times.calls.resize(stages.size());
  for (int done = 0; done < steps; done += kBlock) {
    if (!progress(static_cast<double>(done) / steps, "timing the stages of a step")) return Cancelled();
    const int block = std::min(kBlock, steps - done);
    for (int i = 0; i < block; ++i) times.whole.push_back(plain.Take(subject.parameters, start) - clock);
    for (int i = 0; i < block; ++i) {
      timed.Take(subject.parameters, start);
      Collect(clock, stages, times);
    }
  }
  return times;
}

void AddRow(const Stage& stage, double seconds, double whole, double calls, v1::CostTable& table) {
  v1::StageRow& row = *table.add_stages();
  row.set_stage(stage.stage);
  row.set_element(stage.element);
  row.set_us_per_step(1e6 * seconds);
  row.set_share(whole > 0 ? seconds / whole : 0);
  row.set_calls_per_step(calls);
}

}  // namespace

absl::Status AddStages(const Subject& subject, int steps, const Progress& progress, v1::CostTable& table) {
  Stages stages;
  steps = std::min(steps, kMaxTimedSteps);
  const auto times = Watch(subject, steps, progress, stages);
  if (!times.ok()) return times.status();
  const double whole = MiddleMean(times->whole);
  double sum = 0;
  for (size_t i = 0; i < stages.size(); ++i) {
    if (times->calls[i] == 0) continue;
    const double seconds = std::max(0.0, MiddleMean(times->stages[i]));
    sum += seconds;
    AddRow(stages[i], seconds, whole, static_cast<double>(times->calls[i]) / steps, table);
  }
  AddRow({.stage = "integrator", .element = "remainder", .seconds = 0, .calls = 0, .parts = 0}, whole - sum, whole, 1,
         table);
  AddRow({.stage = "step", .element = "whole", .seconds = 0, .calls = 0, .parts = 0}, whole, whole, 1, table);
  return absl::OkStatus();
}

}  // namespace phrenic::study
