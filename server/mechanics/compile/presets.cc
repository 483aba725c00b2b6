#include "server/mechanics/compile/presets.h"

#include <vector>

#include "absl/strings/str_cat.h"
#include "server/schema/names.h"
#include "server/schema/schema.h"

namespace phrenic {

void CompletePresets(v1::Scene& scene) {
  v1::Parameters start = scene.parameters(), chosen;
  schema::FillDefaults(&start);
  for (const v1::Preset& preset : scene.presets()) chosen.MergeFrom(preset.parameters());
  const auto& descriptor = *v1::Parameters::descriptor();
  const auto& reflection = *v1::Parameters::GetReflection();
  for (int i = 0; i < descriptor.field_count(); ++i) {
    if (!reflection.HasField(chosen, descriptor.field(i))) reflection.ClearField(&start, descriptor.field(i));
  }
  for (v1::Preset& preset : *scene.mutable_presets()) {
    v1::Parameters complete = start;
    complete.MergeFrom(preset.parameters());
    *preset.mutable_parameters() = complete;
  }
}

absl::StatusOr<v1::Parameters> FindPreset(const v1::Scene& scene, const std::string& name) {
  if (name.empty()) return v1::Parameters();
  for (const v1::Preset& preset : scene.presets()) {
    if (preset.name() == name) return preset.parameters();
  }
  std::vector<std::string> names;
  for (const v1::Preset& preset : scene.presets()) names.push_back(preset.name());
  return absl::InvalidArgumentError(
      absl::StrCat("preset: scene \"", scene.name(), "\" has no preset \"", name, "\"", schema::ThereAre(name, names)));
}

}  // namespace phrenic
