#include "server/physiology/physiology.h"

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "server/mechanics/step/step.h"
#include "server/physiology/thorax_metrics.h"

namespace phrenic::physiology {
namespace {

constexpr double kSampleInterval = 0.1;  // between two measurements of the dome's height [s]

// One simulated inspiration.
struct Breath {
  std::string name;
  v1::Parameters parameters;
  State peak = {};
  double dome_speed = 0;  // the fastest descent of the right dome [m/s]
};

// A measure of a breath with its accepted range.
struct Check {
  const char* breath;
  const char* what;
  const char* unit;
  double low, high;
  std::optional<double> (*measure)(const ThoraxMetrics& metrics, const Breath& breath);
};

using Value = std::optional<double>;

// The volume swept by the diaphragm over the change of lung volume [%].
Value AbdominalShare(const ThoraxMetrics& metrics, const Breath& breath) {
  const Value lungs = metrics.LungVolumeChange(breath.peak);
  if (!lungs.has_value() || *lungs <= 0) return std::nullopt;
  return 100 * metrics.SweptVolume(breath.peak) / *lungs;
}

Value Percent(Value part) { return part.has_value() ? Value(100 * *part) : part; }

Value Right(const ThoraxMetrics& m, const Breath& b) { return 1e3 * m.DomeDescent(b.peak, v1::SIDE_RIGHT); }
Value LeftOverRight(const ThoraxMetrics& m, const Breath& b) {
  return m.DomeDescent(b.peak, v1::SIDE_LEFT) / m.DomeDescent(b.peak, v1::SIDE_RIGHT);
}
Value BackOverFront(const ThoraxMetrics& m, const Breath& b) { return m.PosteriorOverAnterior(b.peak); }
Value DomeSpeed(const ThoraxMetrics&, const Breath& b) { return 1e3 * b.dome_speed; }
Value Shortening(const ThoraxMetrics& m, const Breath& b) { return Percent(m.FibreShortening(b.peak)); }
Value Tendon(const ThoraxMetrics& m, const Breath& b) { return Percent(m.TendonAreaChange(b.peak)); }
Value Across(const ThoraxMetrics& m, const Breath& b) { return Percent(m.StrainAcrossFibres(b.peak)); }
Value Thickness(const ThoraxMetrics& m, const Breath& b) { return m.ThicknessRatio(b.peak); }
Value Ventral(const ThoraxMetrics& m, const Breath& b) {
  const auto shift = m.SternumShift(b.peak);
  return shift.has_value() ? Value(-1e3 * shift->y()) : std::nullopt;
}
Value Cranial(const ThoraxMetrics& m, const Breath& b) {
  const auto shift = m.SternumShift(b.peak);
  return shift.has_value() ? Value(1e3 * shift->z()) : std::nullopt;
}
Value Lateral(const ThoraxMetrics& m, const Breath& b) {
  const Value shift = m.LowerRibShift(b.peak);
  return shift.has_value() ? Value(1e3 * *shift) : shift;
}

const Check kChecks[] = {
    {"quiet", "right dome, descent", "mm", 10, 25, &Right},
    {"quiet", "left over right descent", "1", 0.6, 1.1, &LeftOverRight},
    {"quiet", "back over front descent", "1", 1, 10, &BackOverFront},
    {"quiet", "dome speed", "mm/s", 2, 25, &DomeSpeed},
    {"quiet", "fibre shortening", "%", 5, 15, &Shortening},
    {"quiet", "strain across fibres", "%", 0, 5, &Across},
    {"quiet", "tendon area change", "%", 0, 2, &Tendon},
    {"quiet", "sternum forward", "mm", 1.5, 5, &Ventral},
    {"quiet", "sternum upward", "mm", 2, 9, &Cranial},
    {"quiet", "ribs 7-10 outward", "mm", 1.5, 5, &Lateral},
    {"quiet", "abdominal share of volume", "%", 52, 75, &AbdominalShare},
    {"deep", "right dome, descent", "mm", 40, 95, &Right},
    {"deep", "fibre shortening", "%", 20, 35, &Shortening},
    {"deep", "thickness over that at rest", "1", 1.5, 3, &Thickness},
    {"deep", "sternum forward", "mm", 8, 20, &Ventral},
    {"deep", "sternum upward", "mm", 15, 45, &Cranial},
    {"deep", "ribs 7-10 outward", "mm", 9, 20, &Lateral},
    {"diaphragmatic", "abdominal share of volume", "%", 75, 100, &AbdominalShare},
    {"chest", "abdominal share of volume", "%", 0, 35, &AbdominalShare},
};

bool IsChecked(const std::string& breath) {
  return std::any_of(std::begin(kChecks), std::end(kChecks),
                     [&breath](const Check& each) { return each.breath == breath; });
}

std::vector<Breath> BreathsOf(const Model& model) {
  std::vector<Breath> breaths = {{.name = "quiet", .parameters = model.parameters}};
  for (const v1::Preset& preset : model.scene.presets()) {
    if (preset.name() == "quiet" || !IsChecked(preset.name())) continue;
    breaths.push_back({.name = preset.name(), .parameters = model.parameters});
    breaths.back().parameters.MergeFrom(preset.parameters());
  }
  return breaths;
}

// The phase of the peak of inspiration, 0 to 1.
double PeakPhase(const Model& model) {
  return model.scene.breath().waveform() == v1::WAVEFORM_RAISED_COSINE ? 0.5 : 0.25;
}

absl::Status BreatheIn(const Model& model, const ThoraxMetrics& metrics, absl::FunctionRef<bool(double)> progress,
                       Breath& breath) {
  Workspace work = model.MakeWorkspace();
  State& state = breath.peak = model.InitialState();
  const double end = PeakPhase(model) * breath.parameters.breath_length();
  double descent = 0, sampled = 0;
  while (state.time < end) {
    absl::Status stepped = Step(model, breath.parameters, breath.parameters.time_step(), state, work);
    if (!stepped.ok()) {
      return absl::OutOfRangeError(absl::StrCat("the ", breath.name, " breath diverged at ", state.time, " s: lower ",
                                                "time_step, or the preset's breath_force"));
    }
    if (state.time - sampled < kSampleInterval) continue;
    const double now = metrics.DomeDescent(state, v1::SIDE_RIGHT);
    breath.dome_speed = std::max(breath.dome_speed, (now - descent) / (state.time - sampled));
    descent = now, sampled = state.time;
    if (!progress(state.time / end)) return absl::CancelledError("the study was cancelled");
  }
  return absl::OkStatus();
}

v1::PhysiologyRow Judge(const Check& check, const ThoraxMetrics& metrics, const Breath& breath) {
  v1::PhysiologyRow row;
  row.set_breath(breath.name);
  row.set_what(check.what);
  row.set_unit(check.unit);
  row.set_low(check.low);
  row.set_high(check.high);
  const Value value = check.measure(metrics, breath);
  if (!value.has_value()) {
    row.set_verdict(v1::VERDICT_NOT_MODELLED);
    row.set_note("the scene lacks the body or the region that this is measured on");
    return row;
  }
  row.set_value(*value);
  row.set_verdict(check.low <= *value && *value <= check.high ? v1::VERDICT_INSIDE : v1::VERDICT_OUTSIDE);
  return row;
}

}  // namespace

absl::StatusOr<v1::PhysiologyTable> CheckPhysiology(const Model& model, absl::FunctionRef<bool(double)> progress) {
  const absl::StatusOr<ThoraxMetrics> metrics = ThoraxMetrics::Of(model);
  if (!metrics.ok()) return metrics.status();
  v1::PhysiologyTable table;
  table.set_scene(model.scene.name());
  std::vector<Breath> breaths = BreathsOf(model);
  const double fraction = 1.0 / static_cast<double>(breaths.size());
  for (size_t b = 0; b < breaths.size(); ++b) {
    const auto part = [&](double done) { return progress(fraction * (static_cast<double>(b) + done)); };
    if (absl::Status status = BreatheIn(model, *metrics, part, breaths[b]); !status.ok()) return status;
    for (const Check& check : kChecks) {
      if (breaths[b].name == check.breath) *table.add_rows() = Judge(check, *metrics, breaths[b]);
    }
  }
  return table;
}

}  // namespace phrenic::physiology
