#include "client/fitting/simulated_fit.h"

#include <cmath>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/cli/scene_argument.h"
#include "client/files/local_models.h"
#include "client/files/scene_lungs.h"
#include "client/files/scene_text.h"
#include "client/files/whole_file.h"
#include "client/print/joint_fit.h"
#include "client/print/output.h"
#include "server/calibrate/cage_markers.h"
#include "server/calibrate/preset_text.h"
#include "server/mechanics/compile/presets.h"

namespace phrenic::client {
namespace {

constexpr double kOtherDome = 2;  // [mm] between the apex of a dome and the highest quarter of a lung's base

// Measures of the simulation that a fit of the lungs' motion gives: the number's name, the target's, and how much more
// they differ.
constexpr struct {
  const char *number, *target;
  double more;
} kFromMotion[] = {{"tidal volume", "tidal-volume", 0},
                   {"right dome", "right-dome", kOtherDome},
                   {"left dome", "left-dome", kOtherDome}};

const calibrate::Target& TargetOf(const std::string& name) {
  for (const calibrate::Target& target : calibrate::Targets()) {
    if (name == target.name) return target;
  }
  return calibrate::Targets().front();
}

// Adds what the motion of the lungs says, by landmarks and surfaces alone.
absl::Status AddMotion(const v1::SceneSource& source, const std::string& data_dir, const fit::Evidence& evidence,
                       const fit::FitOptions& options, calibrate::BreathFit& fit, calibrate::AllBreathData& data) {
  if (evidence.landmarks.size() == 0 && evidence.surfaces.empty()) return absl::OkStatus();
  fit::Evidence motion = evidence;
  motion.traces.clear();
  motion.markers.clear();
  const auto lungs = ReadSceneLungs(source, data_dir);
  if (!lungs.ok()) return lungs.status();
  const auto found = fit::FitJointly(lungs->templates, motion, options);
  if (!found.ok()) return found.status();
  fit.doubts = found->motion.registered.doubts;
  const std::string from =
      evidence.landmarks.size() > 0 ? evidence.landmarks_kind.source : evidence.surfaces.front().kind.source;
  for (const auto& [number, target, more] : kFromMotion) {
    for (const fit::FittedQuantity& each : found->derived) {
      if (each.number.name != number) continue;
      const double unit = each.number.per_unit;
      data.push_back(calibrate::MeasureData(
          {&TargetOf(target), each.value / unit, std::hypot(each.standard_error / unit, more), from}));
    }
  }
  return absl::OkStatus();
}

bool Sets(const v1::Parameters& settings, const std::vector<calibrate::FittedParameter>& parameters,
          const std::string& name) {
  for (const calibrate::FittedParameter& each : parameters) {
    if (each.varied.field->name() == name) return true;
  }
  return settings.GetReflection()->HasField(settings, settings.GetDescriptor()->FindFieldByName(name));
}

// For a text that people read; the breath changes by a ten-thousandth.
double InFiveDigits(double value) {
  double rounded = value;
  return absl::SimpleAtod(absl::StrFormat("%.5g", value), &rounded) ? rounded : value;
}

v1::Preset PresetToBegin(const v1::Scene& scene, const std::string& name) {
  for (const v1::Preset& preset : scene.presets()) {
    if (preset.name() == name) return preset;
  }
  return {};
}

}  // namespace

absl::StatusOr<SimulatedFit> FitSimulation(const Context& context, const v1::SceneSource& source,
                                           const std::string& name, const fit::Evidence& evidence,
                                           const SimulatedFitOptions& options, const fit::FitOptions& fit,
                                           const std::string& data_dir, calibrate::BreathFitProgress progress) {
  SimulatedFit made;
  const absl::StatusOr<v1::Parameters> settings = ReadSettings(options.settings);
  if (!settings.ok()) return settings.status();
  const absl::StatusOr<v1::Scene> scene = LocalModels(data_dir).Resolve(source);
  if (!scene.ok()) return scene.status();
  made.scene = *scene;  // with presets as they are written
  const auto model = CompileLocally(context, source, name, data_dir);
  if (!model.ok()) return model.status();
  const absl::StatusOr<v1::Parameters> preset = FindPreset((*model)->scene, options.preset);
  if (!preset.ok()) return preset.status();
  made.preset = PresetToBegin(made.scene, options.preset);
  v1::Parameters start = (*model)->parameters, own = made.preset.parameters();
  own.MergeFrom(*settings);
  start.MergeFrom(*preset);  // with what other presets set
  start.MergeFrom(own);
  const auto subject = physiology::Subject::Of(**model);
  if (!subject.ok()) return subject.status();
  std::vector<calibrate::FittedParameter> parameters;
  for (const std::string& text : options.parameters) {
    const auto varied = calibrate::ReadVaried(text);
    if (!varied.ok()) return varied.status();
    parameters.push_back(calibrate::PriorOf(*varied, start));
  }
  if (!evidence.traces.empty() && !Sets(*settings, parameters, "breath_length")) {
    own.set_breath_length(std::round(100 * evidence.traces.front().breaths.lengths.mean()) / 100);
    start.MergeFrom(own);
  }
  calibrate::AllBreathData data;
  calibrate::BreathFit first;
  if (absl::Status status = AddMotion(source, data_dir, evidence, fit, first, data); !status.ok()) return status;
  for (const fit::Evidence::TraceFile& file : evidence.traces) data.push_back(calibrate::TraceData(file));
  for (const fit::Evidence::MarkerFile& file : evidence.markers) {
    auto cage = calibrate::CageData(**subject, file);
    if (!cage.ok()) return cage.status();
    data.push_back(*std::move(cage));
  }
  auto found = calibrate::FitBreath(**subject, start, parameters, data, {}, progress);
  if (!found.ok()) return found.status();
  made.breath = *std::move(found);
  made.breath.doubts.insert(made.breath.doubts.begin(), first.doubts.begin(), first.doubts.end());
  for (const calibrate::FittedParameter& each : parameters) {
    calibrate::SetValue(each.varied, InFiveDigits(calibrate::ValueOf(each.varied, made.breath.parameters)), own);
  }
  made.preset.set_name("fitted");
  made.preset.set_title("Fitted to a person");
  *made.preset.mutable_parameters() = own;
  return made;
}

std::string TextOf(const SimulatedFit& fit, const std::string& source) {
  v1::Preset preset = fit.preset;
  preset.set_description(absl::StrCat("Parameters fitted to ", source, "."));
  std::string names;
  for (const fit::FittedQuantity& each : fit.breath.numbers) {
    if (each.number.what == "of the data") continue;
    absl::StrAppend(&names, names.empty() ? "" : ", ",
                    each.at_bound ? absl::StrCat(each.number.name, " at its bound")
                                  : absl::StrFormat("%s +- %.2g", each.number.name, each.standard_error));
  }
  return calibrate::PresetText(preset, absl::StrCat("Written by phrenic fit from ", source, ": ", names));
}

void PrintSimulated(const Context& context, const SimulatedFit& found, const std::string& source) {
  const calibrate::BreathFit& breath = found.breath;
  for (const std::string& doubt : breath.doubts) std::cerr << "warning: " << doubt << "\n";
  const std::string preset = TextOf(found, source);
  if (context.json()) {
    nlohmann::json json = FittedJson(breath.numbers, breath.derived, breath.kinds);
    for (const auto& row : breath.correlation.rowwise()) {
      json["correlation"].push_back(std::vector<double>(row.begin(), row.end()));
    }
    json.update({{"preset", preset}, {"breaths", breath.breaths}, {"converged", breath.converged}});
    json["doubts"] = breath.doubts;
    PrintJson(json);
  } else if (context.output == Output::kCsv) {
    PrintFittedCsv(breath.numbers, breath.derived, breath.kinds, {});
  } else {
    PrintFitted(breath.numbers, breath.derived, breath.kinds);
    std::cout << absl::StrFormat("\n%d breaths were simulated\n\n", breath.breaths) << preset;
  }
}

absl::Status WriteSimulatedScene(const std::string& file, const SimulatedFit& fit, const std::string& source) {
  v1::Scene scene = fit.scene;
  scene.set_name(std::filesystem::path(file).stem().string());
  scene.mutable_parameters()->MergeFrom(fit.preset.parameters());
  v1::Preset preset = fit.preset;
  preset.set_description(absl::StrCat("Parameters fitted to ", source, "."));
  std::vector<v1::Preset> others(scene.presets().begin(), scene.presets().end());
  scene.clear_presets();
  *scene.add_presets() = preset;
  for (const v1::Preset& other : others) {
    if (other.name() != preset.name()) *scene.add_presets() = other;
  }
  return WriteWhole(file, SceneText(scene, absl::StrCat("Written by phrenic fit from ", source, ".")));
}

}  // namespace phrenic::client
