#include "server/physiology/recording.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "absl/strings/str_format.h"
#include "server/mechanics/step/step.h"
#include "server/physiology/bones.h"

namespace phrenic::physiology {
namespace {

constexpr double kSettling = 4;           // [s]
constexpr double kSampleInterval = 0.02;  // [s]
constexpr double kMostSamples = 400;      // of a breath
constexpr int kMoments = 10;              // of a breath, at which flaws are looked for

class Recorder {
 public:
  Recorder(const Subject& subject, const v1::Parameters& parameters, FlawSearch search, const EachSample& each,
           Recording& recording)
      : subject_(subject),
        parameters_(parameters),
        each_(each),
        recording_(recording),
        next_moment_(search == FlawSearch::kNever ? HUGE_VAL : 0) {
    recording_.flaws.fill(kNone);
    recording_.flaw_time.fill(0);
  }

  void Sample(double time, const State& state, const Workspace& work) {
    const Model& model = subject_.model;
    const EvalContext at = MakeEvalContext(model, parameters_, state, work.scratch);
    std::array<double, kQuantities> now = Pressures(at);
    if (subject_.parts.pressures == nullptr) now[kVolume] = LungSurfaceVolume(model, subject_.parts, state);
    const auto heights = subject_.columns.Heights(Placed(model, state, subject_.parts.sheet));
    std::copy(heights.begin(), heights.end(), now.begin() + kRightApex);
    now[kLowerRibs] = LowerRibShift(model, subject_.parts, state);
    now[kRightRibs] = MiddleRibShift(model, subject_.parts, state, v1::SIDE_RIGHT);
    now[kLeftRibs] = MiddleRibShift(model, subject_.parts, state, v1::SIDE_LEFT);
    Keep(time, now, at.breath, state);
    if (each_) each_(time, at);
    LookForFlaws(time, state);
  }

 private:
  std::array<double, kQuantities> Pressures(const EvalContext& at) const {
    const Force* force = subject_.parts.pressures;
    std::array<double, kQuantities> now;
    now.fill(kNone);
    now[kVolume] = ReadOutput(force, "volume", at);
    now[kFlow] = ReadOutput(force, "flow", at);
    now[kPleural] =
        (ReadOutput(force, "pleural_pressure_right", at) + ReadOutput(force, "pleural_pressure_left", at)) / 2;
    now[kAbdominal] = ReadOutput(force, "abdominal_pressure", at);
    now[kTransdiaphragmatic] = ReadOutput(force, "transdiaphragmatic_pressure", at);
    now[kDisplaced] = ReadOutput(force, "displaced_volume", at);
    return now;
  }

  void Keep(double time, const std::array<double, kQuantities>& now, double signal, const State& state) {
    if (recording_.time.empty()) recording_.base = state;
    recording_.time.push_back(time);
    for (size_t q = 0; q < kQuantities; ++q) recording_.of[q].push_back(now[q]);
    const double fullness = subject_.parts.pressures != nullptr ? now[kVolume] : signal;
    if (recording_.time.size() > 1 && fullness <= fullest_) return;
    fullest_ = fullness;
    recording_.peak = state;
    recording_.peak_sample = recording_.time.size() - 1;
  }

  void LookForFlaws(double time, const State& state) {
    if (time < next_moment_) return;
    next_moment_ += parameters_.breath_length() / kMoments;
    const FlawValues now = subject_.flaws.At(state);
    for (size_t f = 0; f < kFlaws; ++f) {
      if (now[f] <= recording_.flaws[f]) continue;
      recording_.flaws[f] = now[f], recording_.flaw_time[f] = time;
    }
  }

  const Subject& subject_;
  const v1::Parameters& parameters_;
  const EachSample& each_;
  Recording& recording_;
  double fullest_ = 0, next_moment_;
};

// The breaths before the measured one.
int SettlingBreaths(const Subject& subject, double length) {
  if (subject.parts.pressures == nullptr) return 0;
  return static_cast<int>(std::ceil(std::max(1.0, kSettling / length)));
}

}  // namespace

Subject::Subject(const Model& of, Parts found)
    : model(of),
      parts(std::move(found)),
      columns(of.bodies[parts.sheet].mesh),
      fibres(of.bodies[parts.muscle < 0 ? parts.sheet : parts.muscle].mesh),
      flaws(of, parts, columns) {}

absl::StatusOr<std::unique_ptr<const Subject>> Subject::Of(const Model& model) {
  const auto parts = FindParts(model);
  if (!parts.ok()) return parts.status();
  return std::unique_ptr<const Subject>(new Subject(model, *parts));
}

absl::StatusOr<Recording> Record(const Subject& subject, const std::string& breath, const v1::Parameters& parameters,
                                 absl::FunctionRef<bool(double)> progress, FlawSearch search, const EachSample& each) {
  Recording recording;
  recording.subject = &subject;
  recording.breath = breath;
  recording.parameters = parameters;
  Recorder recorder(subject, parameters, search, each, recording);
  Workspace work = subject.model.MakeWorkspace();
  State state = subject.model.InitialState();
  const double length = parameters.breath_length(), interval = std::max(kSampleInterval, length / kMostSamples);
  const double start = SettlingBreaths(subject, length) * length, end = start + length;
  double sampled = start, reported = 0;
  while (true) {
    if (state.time >= sampled) {
      recorder.Sample(state.time - start, state, work);
      sampled += interval;
    }
    if (state.time >= reported) {
      if (!progress(std::min(1.0, state.time / end))) return absl::CancelledError("the study was cancelled");
      reported += 0.1;
    }
    if (state.time >= end) return recording;
    if (!Step(subject.model, parameters, parameters.time_step(), state, work).ok()) {
      recording.problem = absl::StrFormat("the breath diverged at %.3g s: lower time_step", state.time);
      return recording;
    }
  }
}

}  // namespace phrenic::physiology
