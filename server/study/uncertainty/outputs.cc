#include "server/study/uncertainty/outputs.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/mechanics/measures/readings.h"
#include "server/mechanics/stability/largest_step.h"
#include "server/physiology/recording.h"
#include "server/schema/fields.h"
#include "server/schema/names.h"
#include "server/study/watched_run.h"

namespace phrenic::study {
namespace {

constexpr int kMostOutputSamples = 400;  // of a run from rest

std::vector<std::string> MeasureNames(const Model& model) {
  std::vector<std::string> names;
  for (const auto& measure : model.measures) names.push_back(measure->name());
  return names;
}

// The measures of the model in the course of a run.
class MeasureTraces {
 public:
  explicit MeasureTraces(const Model& model) : model_(model), values_(model.measures.size()) {}

  void Sample(double time, const EvalContext& at) {
    times_.push_back(time);
    const MeasureReadings readings = ReadMeasures(model_, at);
    for (size_t i = 0; i < values_.size(); ++i) values_[i].push_back(readings[static_cast<int>(i)].value());
  }

  double StatisticOf(int measure, v1::Statistic statistic) const {
    const std::vector<double>& values = values_[static_cast<size_t>(measure)];
    const auto [least, largest] = std::minmax_element(values.begin(), values.end());
    switch (statistic) {
      case v1::STATISTIC_MINIMUM:
        return *least;
      case v1::STATISTIC_MAXIMUM:
        return *largest;
      case v1::STATISTIC_AMPLITUDE:
        return *largest - *least;
      case v1::STATISTIC_LAST:
        return values.back();
      default:
        return MeanOf(values);
    }
  }

  // Returns each measure at kPhases moments, linearly between two samples.
  std::vector<std::vector<double>> AtPhases() const {
    std::vector<std::vector<double>> curves;
    for (const std::vector<double>& values : values_) {
      std::vector<double>& curve = curves.emplace_back();
      for (int k = 0; k < kPhases; ++k) curve.push_back(At(values, times_.back() * k / (kPhases - 1)));
    }
    return curves;
  }

 private:
  // Over time, by the trapezoidal rule: samples need not be equidistant.
  double MeanOf(const std::vector<double>& values) const {
    double sum = 0;
    for (size_t i = 1; i < values.size(); ++i) sum += (times_[i] - times_[i - 1]) * (values[i] + values[i - 1]) / 2;
    return values.size() > 1 ? sum / (times_.back() - times_.front()) : values.front();
  }

  double At(const std::vector<double>& values, double time) const {
    const auto next = std::upper_bound(times_.begin(), times_.end(), time);
    if (next == times_.begin()) return values.front();
    if (next == times_.end()) return values.back();
    const auto i = static_cast<size_t>(next - times_.begin());
    return std::lerp(values[i - 1], values[i], (time - times_[i - 1]) / (times_[i] - times_[i - 1]));
  }

  const Model& model_;
  std::vector<double> times_;
  std::vector<std::vector<double>> values_;  // one list a measure
};

RunOutputs FailedRun(size_t outputs, std::string problem) {
  return {std::vector<double>(outputs, std::numeric_limits<double>::quiet_NaN()), {}, std::move(problem)};
}

// Statistics of measures now; those of the breath by `of_breath`.
template <typename OfBreath>
RunOutputs ReadRun(const std::vector<Output>& outputs, const MeasureTraces& traces, const OfBreath& of_breath) {
  RunOutputs run{{}, traces.AtPhases(), ""};
  for (const Output& output : outputs) {
    run.values.push_back(output.of_breath != nullptr ? of_breath(*output.of_breath)
                                                     : traces.StatisticOf(output.measure, output.statistic));
  }
  return run;
}

}  // namespace

absl::StatusOr<std::unique_ptr<const Outputs>> Outputs::Make(
    const Model& model, const google::protobuf::RepeatedPtrField<v1::StudiedOutput>& wanted,
    std::optional<double> seconds, bool automatic_step) {
  std::unique_ptr<Outputs> outputs(new Outputs(model, seconds, automatic_step));
  if (!seconds) {
    if (auto breathing = physiology::Subject::Of(model); breathing.ok()) outputs->breathing_ = *std::move(breathing);
  }
  std::set<std::pair<std::string, int>> seen;
  for (int i = 0; i < wanted.size(); ++i) {
    const std::string path = absl::StrCat("outputs[", i, "]");
    if (!seen.emplace(wanted[i].measure(), wanted[i].statistic()).second) {
      return absl::InvalidArgumentError(absl::StrCat(path, ".measure: \"", wanted[i].measure(), "\" is named twice"));
    }
    if (absl::Status status = outputs->AddWanted(wanted[i], path); !status.ok()) return status;
  }
  if (wanted.empty()) {
    if (absl::Status status = outputs->AddDefaults(); !status.ok()) return status;
  }
  return outputs;
}

absl::Status Outputs::AddWanted(const v1::StudiedOutput& wanted, const std::string& path) {
  std::vector<std::string> names = MeasureNames(model_);
  const auto measure = std::find(names.begin(), names.end(), wanted.measure());
  if (measure != names.end()) {
    if (wanted.statistic() == v1::STATISTIC_UNSPECIFIED) {
      return absl::InvalidArgumentError(absl::StrCat(path, ".statistic: must be set for the measure \"",
                                                     wanted.measure(),
                                                     "\": ", schema::ChoiceNames(*v1::Statistic_descriptor())));
    }
    const auto index = static_cast<int>(measure - names.begin());
    const std::string statistic =
        schema::ChoiceName(*v1::Statistic_descriptor()->FindValueByNumber(wanted.statistic()));
    outputs_.push_back({.name = absl::StrCat(wanted.measure(), ", ", statistic),
                        .unit = model_.measures[static_cast<size_t>(index)]->unit(),
                        .measure = index,
                        .statistic = wanted.statistic()});
    return absl::OkStatus();
  }
  for (const calibrate::Target& target : calibrate::Targets()) {
    if (breathing_ == nullptr || !physiology::Has(*breathing_, target.needs)) continue;
    names.emplace_back(target.name);
    if (wanted.measure() != target.name) continue;
    if (wanted.statistic() != v1::STATISTIC_UNSPECIFIED) {
      return absl::InvalidArgumentError(
          absl::StrCat(path, ".statistic: ", target.name, " is one number of a breath and has no statistic"));
    }
    outputs_.push_back({.name = target.name, .unit = target.unit, .of_breath = &target});
    return absl::OkStatus();
  }
  return absl::InvalidArgumentError(absl::StrCat(path, ".measure: there is no measure \"", wanted.measure(), "\"",
                                                 schema::ThereAre(wanted.measure(), names)));
}

absl::Status Outputs::AddDefaults() {
  for (const calibrate::Target& target : calibrate::Targets()) {
    if (breathing_ == nullptr || !physiology::Has(*breathing_, target.needs)) continue;
    outputs_.push_back({.name = target.name, .unit = target.unit, .of_breath = &target});
  }
  if (!outputs_.empty()) return absl::OkStatus();
  for (const std::string& name : MeasureNames(model_)) {
    v1::StudiedOutput wanted;
    wanted.set_measure(name);
    wanted.set_statistic(v1::STATISTIC_AMPLITUDE);
    if (absl::Status status = AddWanted(wanted, "outputs"); !status.ok()) return status;
  }
  if (!outputs_.empty()) return absl::OkStatus();
  return absl::FailedPreconditionError("the scene has no measures, so that a run has no outputs: add `measures` to it");
}

absl::StatusOr<RunOutputs> Outputs::Run(const v1::Parameters& parameters,
                                        const std::function<bool()>& cancelled) const {
  v1::Parameters own = parameters;
  if (automatic_step_) {
    own.set_time_step(std::min(own.time_step(), ChosenStep(LargestStableStep(model_, own))));
  }
  if (breathing_ != nullptr) return Breathe(own, cancelled);
  return RunFromRest(own, seconds_.value_or(own.breath_length()), cancelled);
}

absl::StatusOr<RunOutputs> Outputs::Breathe(const v1::Parameters& parameters,
                                            const std::function<bool()>& cancelled) const {
  MeasureTraces traces(model_);
  const auto recording = physiology::Record(
      *breathing_, "studied", parameters, [&](double) { return !cancelled(); }, physiology::FlawSearch::kNever,
      [&](double time, const EvalContext& at) { traces.Sample(time, at); });
  if (!recording.ok()) return recording.status();
  if (!recording->problem.empty()) return FailedRun(outputs_.size(), recording->problem);
  return ReadRun(outputs_, traces, [&](const calibrate::Target& target) {
    return target.scale * target.measure(*recording, *recording);
  });
}

absl::StatusOr<RunOutputs> Outputs::RunFromRest(const v1::Parameters& parameters, double seconds,
                                                const std::function<bool()>& cancelled) const {
  MeasureTraces traces(model_);
  const Subject subject{.model = std::shared_ptr<const Model>(std::shared_ptr<const Model>(), &model_),
                        .parameters = parameters};
  const Workspace work = model_.MakeWorkspace();
  double next = 0;
  const auto each = [&](const State& state) {
    if (state.time < next && state.time < seconds * (1 - 1e-9)) return;
    next = state.time + seconds / kMostOutputSamples;
    traces.Sample(state.time, MakeEvalContext(model_, parameters, state, work.scratch));
  };
  const auto run = Watch(
      subject, model_.InitialState(), seconds, parameters.time_step(), std::numeric_limits<double>::infinity(),
      [&](double, std::string_view) { return !cancelled(); }, each);
  if (!run.ok()) return run.status();
  if (!run->status.ok()) {
    return FailedRun(outputs_.size(), absl::StrCat("the run diverged at ", schema::FormatNumber(run->divergence.time()),
                                                   " s, ", Where(run->divergence), ": lower time_step"));
  }
  return ReadRun(outputs_, traces, [](const calibrate::Target&) { return std::nan(""); });
}

}  // namespace phrenic::study
