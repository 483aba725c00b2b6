// `phrenic calibrate`: finds the parameters at which a breath has wanted measures, in this process.
#include "server/calibrate/calibrate.h"

#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "client/cli/argument_kinds.h"
#include "client/cli/shared_options.h"
#include "client/commands/commands.h"
#include "client/connection/errors.h"
#include "client/files/local_models.h"
#include "client/files/whole_file.h"
#include "client/print/output.h"
#include "client/print/table.h"
#include "client/terminal/progress.h"
#include "server/calibrate/preset_text.h"
#include "server/mechanics/compile/presets.h"
#include "server/schema/fields.h"
#include "server/service/calls/status.h"

namespace phrenic::client {
namespace {

using calibrate::Calibration;
using schema::FormatNumber;

struct CalibrateOptions {
  SceneOptions scene;
  std::string preset;
  std::vector<std::string> settings;
  std::vector<std::optional<double>> wanted = std::vector<std::optional<double>>(calibrate::Targets().size());
  std::vector<std::string> vary = {"diaphragm_activation", "intercostal_activation"};
  calibrate::SearchLimits limits;
  std::string data_dir, out;  // empty out: no file
};

// Where a calibration begins, and what it writes.
struct CalibrateInput {
  calibrate::Task task;
  std::shared_ptr<const Model> model;
  v1::Parameters start;
  v1::Preset preset;  // as the scene has it, with the settings
};

// Returns the command that was typed, without where its output goes.
std::string CommandOf(const CalibrateOptions& options) {
  std::string line = absl::StrCat("phrenic calibrate ", options.scene.scene);
  if (options.scene.resolution_mm > 0) {
    absl::StrAppend(&line, " --resolution ", FormatNumber(options.scene.resolution_mm));
  }
  for (const std::string& number : options.scene.physique) absl::StrAppend(&line, " --physique ", number);
  if (!options.preset.empty()) absl::StrAppend(&line, " --preset ", options.preset);
  for (const std::string& setting : options.settings) absl::StrAppend(&line, " --set ", setting);
  if (options.vary != CalibrateOptions().vary) {
    for (const std::string& each : options.vary) absl::StrAppend(&line, " --vary ", each);
  }
  for (size_t i = 0; i < options.wanted.size(); ++i) {
    if (!options.wanted[i]) continue;
    absl::StrAppend(&line, " --", calibrate::Targets()[i].name, " ", FormatNumber(*options.wanted[i]));
  }
  if (options.limits.tolerance != calibrate::SearchLimits().tolerance) {
    absl::StrAppend(&line, " --tolerance ", FormatNumber(options.limits.tolerance));
  }
  return line;
}

absl::StatusOr<calibrate::Task> TaskOf(const CalibrateOptions& options) {
  calibrate::Task task;
  task.limits = options.limits;
  for (size_t i = 0; i < options.wanted.size(); ++i) {
    if (options.wanted[i]) task.wanted.push_back({&calibrate::Targets()[i], *options.wanted[i]});
  }
  for (const std::string& text : options.vary) {
    const auto varied = calibrate::ReadVaried(text);
    if (!varied.ok()) return varied.status();
    task.varied.push_back(*varied);
  }
  if (absl::Status status = calibrate::CheckTask(task); !status.ok()) return status;
  return task;
}

v1::Preset PresetOf(const v1::Scene& scene, const std::string& name) {
  for (const v1::Preset& preset : scene.presets()) {
    if (preset.name() == name) return preset;
  }
  v1::Preset preset;
  preset.set_name("calibrated");
  return preset;
}

// Compiles the scene and sets what the calibration begins with.
absl::Status ReadCalibrateScene(const Context& context, const CalibrateOptions& options, CalibrateInput& input) {
  const absl::StatusOr<v1::Parameters> settings = ReadSettings(options.settings);
  if (!settings.ok()) return settings.status();
  const absl::StatusOr<v1::SceneSource> source = ReadScene(options.scene);
  if (!source.ok()) return source.status();
  session::Models models = LocalModels(options.data_dir);
  const absl::StatusOr<v1::Scene> scene = models.Resolve(*source);
  if (!scene.ok()) return scene.status();
  const absl::StatusOr<v1::Parameters> preset = FindPreset(*scene, options.preset);
  if (!preset.ok()) return preset.status();
  const Progress compiling("compiling " + options.scene.scene);
  const auto model = models.Get(*source, {.cancelled = [&context] { return context.interruption->happened(); }});
  if (!model.ok()) return model.status();
  input.model = *model;
  input.start = input.model->parameters;
  input.start.MergeFrom(*preset);
  input.start.MergeFrom(*settings);
  input.preset = PresetOf(*scene, options.preset);
  input.preset.mutable_parameters()->MergeFrom(*settings);
  return absl::OkStatus();
}

absl::StatusOr<Calibration> RunCalibration(const Context& context, const CalibrateInput& input) {
  const auto subject = physiology::Subject::Of(*input.model);
  if (!subject.ok()) return subject.status();
  Progress progress("calibrating " + input.model->scene.name());
  return calibrate::Calibrate(**subject, input.start, input.task, [&](int breaths, double residual) {
    progress.SetDetail(breaths == 0 ? "breath 1"
                                    : absl::StrFormat("breath %d, off by %.3g %%", breaths + 1, 100 * residual));
    return !context.interruption->happened();
  });
}

void PrintFound(const Calibration& found) {
  Table parameters({"parameter", "start", "found", "lower bound", "upper bound", "unit"});
  for (const calibrate::FoundParameter& each : found.parameters) {
    parameters.Add({each.varied.field->name(), FormatNumber(each.start), FormatNumber(each.value),
                    FormatNumber(each.varied.low), FormatNumber(each.varied.high),
                    calibrate::QuantityOf(each.varied).unit()});
  }
  parameters.Print(std::cout);
  Table measures({"measure", "wanted", "got", "off by %", "unit"});
  for (const calibrate::FoundMeasure& each : found.measures) {
    measures.Add({each.wanted.target->name, FormatNumber(each.wanted.value), absl::StrFormat("%.4g", each.got),
                  absl::StrFormat("%.2f", 100 * each.deviation), each.wanted.target->unit});
  }
  measures.Print(std::cout);
  std::cout << absl::StrFormat("residual %.2f %% after %d breaths\n\n", 100 * found.residual, found.breaths);
}

void PrintFoundCsv(const Calibration& found) {
  Table rows({"kind", "name", "unit", "value", "wanted", "deviation", "start", "low", "high"});
  for (const calibrate::FoundParameter& each : found.parameters) {
    rows.Add({"parameter", each.varied.field->name(), calibrate::QuantityOf(each.varied).unit(),
              FormatNumber(each.value), "", "", FormatNumber(each.start), FormatNumber(each.varied.low),
              FormatNumber(each.varied.high)});
  }
  for (const calibrate::FoundMeasure& each : found.measures) {
    rows.Add({"measure", each.wanted.target->name, each.wanted.target->unit, FormatNumber(each.got),
              FormatNumber(each.wanted.value), FormatNumber(each.deviation), "", "", ""});
  }
  rows.PrintCsv(std::cout);
}

void PrintFoundJson(const std::string& command, const Calibration& found, const std::string& preset) {
  nlohmann::json parameters = nlohmann::json::array(), measures = nlohmann::json::array();
  for (const calibrate::FoundParameter& each : found.parameters) {
    parameters.push_back({{"name", each.varied.field->name()},
                          {"unit", calibrate::QuantityOf(each.varied).unit()},
                          {"start", each.start},
                          {"value", each.value},
                          {"low", each.varied.low},
                          {"high", each.varied.high}});
  }
  for (const calibrate::FoundMeasure& each : found.measures) {
    measures.push_back({{"name", each.wanted.target->name},
                        {"unit", each.wanted.target->unit},
                        {"wanted", each.wanted.value},
                        {"got", each.got},
                        {"deviation", each.deviation}});
  }
  const nlohmann::json json = {{"command", command},         {"reached", found.reached}, {"reason", found.reason},
                               {"residual", found.residual}, {"breaths", found.breaths}, {"parameters", parameters},
                               {"measures", measures},       {"preset", preset}};
  PrintJson(json);
}

void PrintCalibration(const Context& context, const std::string& command, const Calibration& found,
                      const std::string& preset) {
  if (context.json()) {
    PrintFoundJson(command, found, preset);
  } else if (context.output == Output::kCsv) {
    PrintFoundCsv(found);
  } else {
    PrintFound(found);
    std::cout << preset;
  }
}

int Calibrate(const Context& context, const CalibrateOptions& options) {
  const auto task = TaskOf(options);
  if (!task.ok()) {
    return Fail(task.status());
  }
  CalibrateInput input{*task, nullptr, {}, {}};
  if (absl::Status status = ReadCalibrateScene(context, options, input); !status.ok()) {
    return Fail(context, service::ToGrpc(status));
  }
  const auto found = RunCalibration(context, input);
  if (!found.ok()) return Fail(context, service::ToGrpc(found.status()));
  for (const calibrate::FoundParameter& each : found->parameters) {
    calibrate::SetValue(each.varied, each.value, *input.preset.mutable_parameters());
  }
  const std::string command = CommandOf(options), preset = calibrate::PresetText(input.preset, command);
  PrintCalibration(context, command, *found, preset);
  if (!found->reached) {
    std::cerr << ErrorPrefix() << " the wanted measures were not reached: " << found->reason << "\n";
    return kMissed;
  }
  if (options.out.empty()) return kOk;
  if (const absl::Status status = WriteWhole(options.out, preset); !status.ok()) return Fail(status);
  std::cerr << "wrote " << options.out << "\n";
  return kOk;
}

void AddTargets(CLI::App& command, std::vector<std::optional<double>>& wanted) {
  for (size_t i = 0; i < wanted.size(); ++i) {
    const calibrate::Target& target = calibrate::Targets()[i];
    const bool pure = std::string(target.unit) == "1";
    command
        .add_option(absl::StrCat("--", target.name), wanted[i],
                    pure ? target.help : absl::StrCat(target.help, " [", target.unit, "]"))
        ->check(NumberIn(target.low, target.high));
  }
}

}  // namespace

CommandFunction SetUpCalibrate(CLI::App& command) {
  const auto options = std::make_shared<CalibrateOptions>();
  AddScene(command, options->scene);
  command.add_option("--preset", options->preset, "the preset of the scene to begin with (the scene's own parameters)");
  AddParameters(command, options->settings);
  AddTargets(command, options->wanted);
  command
      .add_option("--vary", options->vary,
                  absl::StrCat("a live parameter to vary, within its range or these bounds; may be repeated (",
                               absl::StrJoin(options->vary, ", "), ")"))
      ->check(ParsedBy([](const std::string& text) { return calibrate::ReadVaried(text).status(); }))
      ->allow_extra_args(false);
  command
      .add_option("--tolerance", options->limits.tolerance,
                  "largest deviation of a measure, as a part of its wanted value")
      ->check(NumberIn(1e-4, 0.5))
      ->capture_default_str();
  command.add_option("--tries", options->limits.tries, "largest number of breaths to try")
      ->check(NumberIn(1, 10'000))
      ->capture_default_str();
  AddDataFolder(command, options->data_dir);
  command.add_option("--out", options->out, "write the preset to this file as well, if the measures are reached");
  return Bind(&Calibrate, options);
}

}  // namespace phrenic::client
