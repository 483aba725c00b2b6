// `phrenic fluoroscopy`: an X-ray picture of a scene at one time of a run in this process.
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/cli/argument_kinds.h"
#include "client/cli/shared_options.h"
#include "client/commands/commands.h"
#include "client/connection/errors.h"
#include "client/files/local_models.h"
#include "client/files/whole_file.h"
#include "client/print/output.h"
#include "client/terminal/progress.h"
#include "server/fluoroscopy/picture_file.h"
#include "server/imaging/gzip.h"
#include "server/mechanics/step/step.h"
#include "server/service/calls/status.h"

namespace phrenic::client {
namespace {

struct FluoroscopyOptions {
  SceneOptions scene;
  std::string preset, view = "pa", out, data_dir;
  std::vector<std::string> settings;
  double at = 0;                    // time of the run [s]
  std::optional<double> low, high;  // line integrals that are black and white in a .png; unset: chosen by the picture
  std::optional<double> lao;        // in place of the view's [degrees]
  double cranial = 0, distance = 1.8;  // [degrees], [m]
  int size = 768;
  bool dark_bones = false;
};

bool IsNifti(const std::string& file) { return absl::EndsWith(file, ".nii") || absl::EndsWith(file, ".nii.gz"); }

absl::Status CheckFile(const std::string& file) {
  if (IsNifti(file) || absl::EndsWith(file, ".png")) return absl::OkStatus();
  return absl::InvalidArgumentError(
      absl::StrCat("--out ", file, ": the formats are .png (grey), .nii and .nii.gz (line integrals)"));
}

constexpr double kLeastDistance = 0.8;  // [m]: the source is outside every patient

absl::StatusOr<fluoroscopy::CArm> ReadArm(const FluoroscopyOptions& options) {
  if (options.distance > 0 && options.distance < kLeastDistance) {
    return absl::InvalidArgumentError(absl::StrCat("--distance ", options.distance,
                                                   ": the source would be in the patient; give ", kLeastDistance,
                                                   " m or more, or 0 for parallel rays"));
  }
  absl::StatusOr<fluoroscopy::CArm> arm = fluoroscopy::NamedArm(options.view);
  if (!arm.ok()) return arm;
  if (options.lao) arm->lao = *options.lao;
  arm->cranial = options.cranial;
  arm->source_to_detector = options.distance;
  return arm;
}

absl::StatusOr<std::shared_ptr<const Model>> CompileScene(const Context& context, const FluoroscopyOptions& options) {
  const absl::StatusOr<v1::SceneSource> source = ReadScene(options.scene);
  if (!source.ok()) return source.status();
  return CompileLocally(context, *source, options.scene.scene, options.data_dir);
}

// Runs the model from its initial state until the time.
absl::StatusOr<State> StateAt(const Context& context, const FluoroscopyOptions& options, const Model& model) {
  const absl::StatusOr<v1::Parameters> parameters = ChosenParameters(model, options.preset, options.settings);
  if (!parameters.ok()) return parameters.status();
  State state = model.InitialState();
  Workspace work = model.MakeWorkspace();
  Progress progress("breathing", options.at);
  while (state.time < options.at - 1e-9) {
    if (context.interruption->happened()) return absl::CancelledError("the run was interrupted");
    if (absl::Status status = Step(model, *parameters, parameters->time_step(), state, work); !status.ok()) {
      return absl::Status(status.code(), absl::StrFormat("at %.3f s: %s", state.time, std::string(status.message())));
    }
    progress.Update(state.time);
  }
  return state;
}

absl::Status WritePicture(const FluoroscopyOptions& options, const fluoroscopy::Picture& sums,
                          const fluoroscopy::Projection& projection, bool mirrored) {
  std::string bytes;
  if (IsNifti(options.out)) {
    bytes = fluoroscopy::WriteNifti(sums, projection);
    if (absl::EndsWith(options.out, ".gz")) bytes = imaging::Deflate(bytes);
  } else {
    const fluoroscopy::Picture shown = mirrored ? fluoroscopy::Picture(sums.rowwise().reverse()) : sums;
    fluoroscopy::Window window = fluoroscopy::WindowOf(sums);
    window = {options.low.value_or(window.low), options.high.value_or(window.high)};
    if (!(window.low < window.high)) {
      return absl::InvalidArgumentError(
          absl::StrFormat("the window is %g to %g: --high must be above --low", window.low, window.high));
    }
    bytes = fluoroscopy::WritePng(shown, window, options.dark_bones);
  }
  return WriteWhole(options.out, bytes);
}

void PrintFluoroscopy(const Context& context, const FluoroscopyOptions& options, const State& state,
                      const fluoroscopy::Absorbers& absorbers, const fluoroscopy::Picture& sums) {
  if (context.json()) {
    nlohmann::json lungs = nlohmann::json::object();
    for (const auto& lung : absorbers.lungs) lungs[lung.name] = lung.density;
    PrintJson({{"file", options.out},
               {"time", state.time},
               {"surfaces", absorbers.all.size()},
               {"left_out", absorbers.open},
               {"lung_density_g_cm3", lungs},
               {"largest_integral", sums.maxCoeff()}});
    return;
  }
  std::cout << absl::StrFormat("%s: t = %.3f s, %d surfaces, largest line integral %.2f\n", options.out, state.time,
                               absorbers.all.size(), sums.maxCoeff());
  for (const auto& lung : absorbers.lungs) std::cout << absl::StrFormat("%s: %.3f g/cm3\n", lung.name, lung.density);
  for (const std::string& name : absorbers.open) std::cout << name << ": left out, its surface is open\n";
}

absl::Status MakePicture(const Context& context, const FluoroscopyOptions& options) {
  const absl::StatusOr<fluoroscopy::CArm> arm = ReadArm(options);
  if (!arm.ok()) return arm.status();
  const auto model = CompileScene(context, options);
  if (!model.ok()) return model.status();
  const absl::StatusOr<State> state = StateAt(context, options, **model);
  if (!state.ok()) return state.status();
  const absl::StatusOr<fluoroscopy::Absorbers> absorbers = fluoroscopy::AbsorbersAt(**model, *state);
  if (!absorbers.ok()) return absorbers.status();
  const fluoroscopy::Projection projection = fluoroscopy::ProjectionOf(*arm, absorbers->isocentre);
  const fluoroscopy::Picture sums = fluoroscopy::LineIntegrals(absorbers->all, projection, options.size);
  absl::Status written = WritePicture(options, sums, projection, fluoroscopy::IsMirrored(*arm));
  if (written.ok()) PrintFluoroscopy(context, options, *state, *absorbers, sums);
  return written;
}

int Fluoroscopy(const Context& context, const FluoroscopyOptions& options) {
  if (absl::Status status = CheckFile(options.out); !status.ok()) return Fail(status);
  const absl::Status status = MakePicture(context, options);
  return status.ok() ? kOk : Fail(context, service::ToGrpc(status));
}

}  // namespace

CommandFunction SetUpFluoroscopy(CLI::App& command) {
  const auto options = std::make_shared<FluoroscopyOptions>();
  AddScene(command, options->scene);
  AddPreset(command, options->preset);
  AddParameters(command, options->settings);
  command.add_option("--out", options->out, "file to write: .png (grey), .nii or .nii.gz (line integrals)")->required();
  command.add_option("--at", options->at, "time of the run [s]")->check(NumberIn(0.0, 600.0))->capture_default_str();
  command.add_option("--view", options->view, "pa, ap, left-lateral, lao-30 or rao-30")->capture_default_str();
  command.add_option("--lao", options->lao, "angle of the detector to the patient's left, negative RAO [degrees]")
      ->check(NumberIn(-180.0, 180.0));
  command.add_option("--cranial", options->cranial, "angle of the detector to the head, negative caudal [degrees]")
      ->check(NumberIn(-45.0, 45.0))
      ->capture_default_str();
  command.add_option("--distance", options->distance, "from source to detector [m]; 0: parallel rays")
      ->check(NumberIn(0.0, 10.0))
      ->capture_default_str();
  command.add_option("--size", options->size, "pixels each way, of 42 cm")
      ->check(NumberIn(16, 4096))
      ->capture_default_str();
  for (const auto& [flag, value, grey] :
       {std::tuple("--low", &options->low, "black"), std::tuple("--high", &options->high, "white")}) {
    command
        .add_option(flag, *value, std::string("line integral that is ") + grey + " in a .png (chosen by the picture)")
        ->check(NumberIn(-100.0, 100.0));
  }
  command.add_flag("--dark-bones", options->dark_bones, "dark where little passes, as on a fluorescent screen");
  AddDataFolder(command, options->data_dir);
  return Bind(&Fluoroscopy, options);
}

}  // namespace phrenic::client
