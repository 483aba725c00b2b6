#include "server/physiology/plan.h"

#include <google/protobuf/text_format.h>

#include <algorithm>
#include <optional>
#include <string_view>

#include "absl/strings/str_cat.h"
#include "server/mechanics/compile/presets.h"

namespace phrenic::physiology {
namespace {

constexpr const char* kQuiet = "quiet";

const ChangedBreath* FindChanged(std::string_view breath) {
  for (const ChangedBreath& each : ChangedBreaths()) {
    if (breath == each.name) return &each;
  }
  return nullptr;
}

// The preset of a breath.
std::string PresetOf(std::string_view breath) {
  const ChangedBreath* changed = FindChanged(breath);
  return changed == nullptr ? std::string(breath) : changed->preset;
}

// Returns the parameters of a breath; nullopt if the scene lacks its preset.
std::optional<v1::Parameters> ParametersOf(const Model& model, const std::string& breath) {
  v1::Parameters parameters = model.parameters;
  const auto preset = FindPreset(model.scene, PresetOf(breath));
  if (preset.ok()) parameters.MergeFrom(*preset);
  if (!preset.ok() && PresetOf(breath) != kQuiet) return std::nullopt;
  if (const ChangedBreath* changed = FindChanged(breath)) {
    v1::Parameters changes;
    google::protobuf::TextFormat::ParseFromString(changed->changes, &changes);
    parameters.MergeFrom(changes);
  }
  return parameters;
}

// Collects breaths, each once.
class Plan {
 public:
  explicit Plan(const Subject& subject) : subject_(subject) {}

  void Add(const std::string& breath) {
    const auto is_this = [&](const PlannedBreath& each) { return each.name == breath; };
    if (breath.empty() || std::any_of(breaths_.begin(), breaths_.end(), is_this)) return;
    if (const auto parameters = ParametersOf(subject_.model, breath)) breaths_.push_back({breath, *parameters});
  }

  void AddOf(std::span<const Row> rows, std::span<const std::string> presets) {
    for (const Row& row : rows) {
      if (!IsChosen(row, presets) || !Has(subject_, row.needs)) continue;
      Add(row.other);
      Add(row.breath);
    }
  }

  std::vector<PlannedBreath> Take() { return std::move(breaths_); }

 private:
  const Subject& subject_;
  std::vector<PlannedBreath> breaths_;
};

}  // namespace

bool Has(const Subject& subject, Needs needs) {
  switch (needs) {
    case Needs::kSheet:
      return true;
    case Needs::kFibres:
      return subject.fibres.found();
    case Needs::kWall:
      return subject.parts.wall >= 0 && subject.parts.muscle >= 0 && subject.parts.muscle != subject.parts.sheet;
    case Needs::kBones:
      return subject.parts.sternum >= 0 && !subject.parts.ribs.empty();
    case Needs::kLungs:
      return !subject.parts.lungs.empty();
    case Needs::kPressures:
      return subject.parts.pressures != nullptr;
  }
  return false;
}

std::string NameOf(Needs needs) {
  switch (needs) {
    case Needs::kSheet:
      return "diaphragm";
    case Needs::kFibres:
      return "regions \"rim\" and \"tendon\" on its diaphragm";
    case Needs::kWall:
      return "inner wall along which a simulated middle surface slides";
    case Needs::kBones:
      return "ribs and sternum";
    case Needs::kLungs:
      return "lungs";
    case Needs::kPressures:
      return "pressures of lungs and abdomen (forces { thorax_pressures })";
  }
  return "";
}

bool IsChosen(const Row& row, std::span<const std::string> presets) {
  return presets.empty() || std::find(presets.begin(), presets.end(), PresetOf(row.breath)) != presets.end();
}

absl::StatusOr<std::vector<PlannedBreath>> PlanBreaths(const Subject& subject, std::span<const std::string> presets) {
  const size_t breaths = presets.empty() ? static_cast<size_t>(subject.model.scene.presets_size()) : presets.size();
  if (breaths > kMostPresets) {
    return absl::InvalidArgumentError(
        absl::StrCat("presets: these are ", breaths, ", and one table takes at most ", kMostPresets, ": name fewer"));
  }
  Plan plan(subject);
  for (const std::string& preset : presets) {
    const auto known = FindPreset(subject.model.scene, preset);
    if (!known.ok() && preset != kQuiet) {
      return absl::InvalidArgumentError(absl::StrCat("presets: ", std::string(known.status().message())));
    }
    plan.Add(preset);
  }
  if (presets.empty()) {
    plan.Add(kQuiet);
    for (const v1::Preset& preset : subject.model.scene.presets()) plan.Add(preset.name());
  }
  plan.AddOf(RowsOfHealth(), presets);
  plan.AddOf(RowsOfChanges(), presets);
  return plan.Take();
}

}  // namespace phrenic::physiology
