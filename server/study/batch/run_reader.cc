#include "server/study/batch/run_reader.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>
#include <vector>

#include "server/mechanics/constraint_residual.h"
#include "server/mechanics/measures/readings.h"

namespace phrenic::study {
namespace {

using WallClock = std::chrono::steady_clock;

constexpr std::int64_t kLeastReadings = 40;  // of a summary, unless the run has fewer steps
constexpr double kSameStep = 1e-9;           // part of a step by which a run may end before its time

// Returns the steps at which samples are taken, from the start: those whose end is nearest to each sample's time, each
// once, the last one at the end of the run.
std::vector<std::int64_t> SampledTicks(double seconds, double samples_per_second, double dt) {
  std::vector<std::int64_t> ticks;
  const std::int64_t samples = std::max<std::int64_t>(1, std::llround(seconds * samples_per_second));
  for (std::int64_t i = 1; i <= samples; ++i) {
    const double steps = static_cast<double>(i) / (samples_per_second * dt);
    const std::int64_t tick = std::max<std::int64_t>(1, static_cast<std::int64_t>(std::nearbyint(steps)));
    if (ticks.empty() || tick > ticks.back()) ticks.push_back(tick);
  }
  return ticks;
}

// Appends each sample to the result.
class Sampler final : public RunReader {
 public:
  Sampler(const Subject& subject, const State& start, std::vector<std::int64_t> ticks, v1::BatchResult& result)
      : RunReader(subject, start), model_(*subject.model), ticks_(std::move(ticks)), result_(result) {}

  std::int64_t steps() const override { return ticks_.back(); }

 private:
  bool IsDue(std::int64_t step) override { return next_ < ticks_.size() && step >= ticks_[next_]; }

  void Read(const State& state, const EvalContext& at) override {
    ++next_;
    result_.add_times(state.time);
    for (const v1::MeasureReading& reading : ReadMeasures(model_, at)) result_.add_measures(reading.value());
  }

  const Model& model_;
  const std::vector<std::int64_t> ticks_;
  size_t next_ = 0;
  v1::BatchResult& result_;
};

// Keeps the range of each measure, and the largest violation of a constraint.
class Summariser final : public RunReader {
 public:
  Summariser(const Subject& subject, const State& start, std::int64_t steps, std::int64_t interval,
             v1::BatchSummary& summary)
      : RunReader(subject, start), model_(*subject.model), steps_(steps), interval_(interval), summary_(summary) {}

  std::int64_t steps() const override { return steps_; }

 private:
  bool IsDue(std::int64_t step) override {
    step_ = step;
    return step > 0 && (step % interval_ == 0 || step == steps_);
  }

  void Read(const State& state, const EvalContext& at) override {
    summary_.set_steps(step_);
    summary_.set_simulated_seconds(state.time);
    summary_.set_wall_seconds(std::chrono::duration<double>(WallClock::now() - began_).count());
    int column = 0;
    for (const v1::MeasureReading& reading : ReadMeasures(model_, at)) Note(column++, reading.value());
    if (model_.constraints.empty()) return;
    const double violation = LargestResidual(model_, state).metres;
    summary_.set_constraint_residual(std::max(summary_.constraint_residual(), violation));
  }

  void Note(int column, double value) {
    if (column == summary_.last_size()) {
      summary_.add_last(value), summary_.add_least(value), summary_.add_greatest(value);
    }
    summary_.set_last(column, value);
    summary_.set_least(column, std::min(summary_.least(column), value));
    summary_.set_greatest(column, std::max(summary_.greatest(column), value));
  }

  const Model& model_;
  const std::int64_t steps_, interval_;
  const WallClock::time_point began_ = WallClock::now();
  std::int64_t step_ = 0;
  v1::BatchSummary& summary_;
};

}  // namespace

RunReader::RunReader(const Subject& subject, const State& start)
    : subject_(subject), work_(subject.model->MakeWorkspace()), start_(start.tick) {}

void RunReader::Look(const State& state) {
  if (!IsDue(state.tick - start_)) return;
  Read(state, MakeEvalContext(*subject_.model, subject_.parameters, state, work_.scratch));
  has_read_ = true;
  last_ = state;
}

std::unique_ptr<RunReader> RunReader::Make(const v1::RunBatchRequest& request, const Subject& subject,
                                           const State& start, v1::BatchResult& result) {
  const double dt = subject.parameters.time_step(), fps = request.frames_per_second();
  if (!request.summary()) {
    return std::make_unique<Sampler>(subject, start, SampledTicks(request.seconds(), fps, dt), result);
  }
  const auto steps = std::max<std::int64_t>(1, std::llround(std::ceil(request.seconds() / dt - kSameStep)));
  const std::int64_t often = std::max<std::int64_t>(1, std::llround(1 / (fps * dt)));
  const std::int64_t interval = std::min(often, std::max<std::int64_t>(1, steps / kLeastReadings));
  return std::make_unique<Summariser>(subject, start, steps, interval, *result.mutable_summary());
}

}  // namespace phrenic::study
