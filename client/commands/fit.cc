// `phrenic register` and `phrenic fit`: a scene's lungs moved onto a person's, and the person's breath, in this
// process.
#include <algorithm>
#include <filesystem>
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
#include "client/files/measured_files.h"
#include "client/files/motion_vectors.h"
#include "client/files/person_file.h"
#include "client/files/person_structures.h"
#include "client/files/scene_lungs.h"
#include "client/files/whole_file.h"
#include "client/fitting/simulated_fit.h"
#include "client/print/joint_fit.h"
#include "client/print/motion_fit.h"
#include "client/print/output.h"
#include "client/terminal/progress.h"
#include "server/fit/joint_fit.h"
#include "server/fit/motion_fit.h"
#include "server/fit/read_landmarks.h"
#include "server/meshio/meshio.h"
#include "server/service/calls/status.h"

namespace phrenic::client {
namespace {

struct RegisterOptions {
  SceneOptions scene;
  std::vector<std::string> exhale, surfaces;
  std::string volume, labels = "totalsegmentator";
  std::string data_dir, out;  // empty out: no files
};

struct FitCommandOptions {
  SceneOptions scene;
  MeasuredOptions data;
  std::optional<double> descent, tidal_volume;  // [mm], [l]
  fit::FitOptions fit;
  SimulatedFitOptions simulated;
  bool show_landmarks = false;                     // in the scene
  std::string data_dir, residuals, expected, out;  // files; empty: none
  std::string source;
};

int FailFit(const Context& context, const absl::Status& status) { return Fail(context, service::ToGrpc(status)); }

// Writes lungs as surfaces.
absl::Status WriteLungs(const std::string& folder, const std::array<Mesh, 2>& lungs) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  for (const fit::Side side : {fit::kRight, fit::kLeft}) {
    const std::string file = absl::StrCat(folder, side == fit::kLeft ? "/lung-left.obj" : "/lung-right.obj");
    const auto bytes = meshio::Write(file, lungs[side], 0.001);
    if (!bytes.ok()) return bytes.status();
    if (absl::Status status = WriteWhole(file, *bytes); !status.ok()) return status;
    std::cerr << "wrote " << file << "\n";
  }
  return absl::OkStatus();
}

// What a person's lungs are registered to.
struct RegisterInput {
  Points points;
  std::vector<fit::PersonStructure> structures;  // empty: points alone
};

absl::StatusOr<RegisterInput> ReadRegisterInput(const RegisterOptions& options) {
  if (!options.exhale.empty()) {
    const auto points = fit::ReadLandmarks(options.exhale);
    if (!points.ok()) return points.status();
    return RegisterInput{points->exhale, {}};
  }
  auto structures =
      options.volume.empty() ? ReadStructures(options.surfaces) : ReadLabelledLungs(options.volume, options.labels);
  if (!structures.ok()) return structures.status();
  auto points = fit::PointsInLungs(*structures);
  if (!points.ok()) return points.status();
  return RegisterInput{*std::move(points), *std::move(structures)};
}

int RegisterPerson(const Context& context, const RegisterOptions& options) {
  const int given =
      (options.exhale.empty() ? 0 : 1) + (options.surfaces.empty() ? 0 : 1) + (options.volume.empty() ? 0 : 1);
  if (given != 1) {
    return Fail(absl::InvalidArgumentError("give one of --exhale (points), --surface (files) and --volume (labels)"));
  }
  const auto input = ReadRegisterInput(options);
  if (!input.ok()) return FailFit(context, input.status());
  const absl::StatusOr<v1::SceneSource> scene = ReadScene(options.scene);
  if (!scene.ok()) return Fail(scene.status());
  const auto lungs = ReadSceneLungs(*scene, options.data_dir);
  if (!lungs.ok()) return FailFit(context, lungs.status());
  const auto registered =
      WithProgress("registering", [&] { return fit::RegisterLungs(lungs->templates, input->points); });
  if (!registered.ok()) return FailFit(context, registered.status());
  PrintDoubts(*registered);
  std::array<Mesh, 2> surfaces;
  for (const fit::Side side : {fit::kRight, fit::kLeft}) {
    surfaces[side] = registered->lungs[side].Apply(lungs->templates[side].surface());
  }
  StructureResiduals residuals;
  if (!input->structures.empty()) {
    const auto bent =
        WithProgress("bending", [&] { return fit::BendLungs(lungs->templates, *registered, input->structures); });
    if (!bent.ok()) return FailFit(context, bent.status());
    surfaces = bent->surfaces;
    residuals = {fit::CompareStructures(lungs->templates, *registered, input->structures),
                 fit::CompareStructures(*bent, input->structures), bent->most};
  }
  if (context.json()) {
    PrintJson(RegistrationJson(*registered, residuals));
  } else if (context.output == Output::kCsv) {
    PrintRegistrationCsv(*registered);
  } else {
    PrintRegistration(*registered);
    PrintStructures(residuals);
  }
  if (options.out.empty()) return kOk;
  const absl::Status written = WriteLungs(options.out, surfaces);
  return written.ok() ? kOk : Fail(written);
}

// Returns what is wrong with the combination of options; empty if nothing is.
std::string JointUsageFault(const FitCommandOptions& options) {
  if (options.descent || options.tidal_volume) {
    return "--descent and --tidal-volume belong to --exhale alone: give a recording as --volume or --m-mode";
  }
  if (options.fit.assimilate) return "--assimilate belongs to --landmarks alone";
  if (!options.expected.empty()) return "--expected belongs to --exhale with one number";
  const bool pairs = !options.data.landmarks.empty();
  if (!options.residuals.empty() && !pairs) return "--residuals belongs to --landmarks";
  if (options.show_landmarks && (options.out.empty() || !pairs)) {
    return "--show-landmarks belongs to --landmarks with --out";
  }
  return "";
}

std::string SimulatedUsageFault(const FitCommandOptions& options) {
  if (options.descent || options.tidal_volume || options.fit.assimilate || options.show_landmarks ||
      !options.expected.empty() || !options.residuals.empty()) {
    return "--parameters fits a simulation: leave --descent, --tidal-volume, --assimilate, --show-landmarks, "
           "--expected "
           "and --residuals out";
  }
  const MeasuredOptions& data = options.data;
  if (!data.landmarks.empty() || !data.surfaces.empty() || !data.lung_surfaces.empty() || !data.volumes.empty() ||
      !data.m_modes.empty() || !data.markers.empty()) {
    return "";
  }
  return "--parameters needs data: --volume, --m-mode, --markers, --landmarks, --surface or --lung-surface";
}

std::string FitUsageFault(const FitCommandOptions& options) {
  if (!options.simulated.parameters.empty()) return SimulatedUsageFault(options);
  if (HasOtherKinds(options.data)) return JointUsageFault(options);
  const bool number = options.descent || options.tidal_volume;
  if (options.data.landmarks.empty() == options.data.exhale.empty()) {
    return "give --landmarks with pairs, --exhale with one number (--descent or --tidal-volume), or any of --surface, "
           "--lung-surface, --volume, --m-mode and --markers";
  }
  if (!options.data.landmarks.empty() && number) return "--descent and --tidal-volume belong to --exhale";
  if (!options.data.exhale.empty() && options.descent.has_value() == options.tidal_volume.has_value()) {
    return "--exhale needs one number: --descent or --tidal-volume";
  }
  if (!options.data.landmarks.empty() && !options.expected.empty()) return "--expected belongs to --exhale";
  const bool fitting = !options.residuals.empty() || options.fit.assimilate;
  if (!options.data.exhale.empty() && fitting) return "--residuals and --assimilate belong to --landmarks";
  if (options.show_landmarks && (options.out.empty() || options.data.landmarks.empty())) {
    return "--show-landmarks belongs to --landmarks with --out";
  }
  if (options.show_landmarks && options.fit.assimilate) {
    return "--show-landmarks shows what the numbers leave: leave --assimilate out";
  }
  return "";
}

// Returns what the points are of: by --source, or the files' names.
std::string SourceOf(const FitCommandOptions& options, const std::vector<std::string>& files) {
  if (!options.source.empty()) return options.source;
  std::vector<std::string> names;
  names.reserve(files.size());
  for (const std::string& file : files) names.push_back(std::filesystem::path(file).filename().string());
  return absl::StrJoin(names, " and ");
}

fit::FitProgress ShowOn(Progress& progress, const Context& context) {
  return [&](double done, std::string_view stage) {
    progress.SetDetail(std::string(stage));
    progress.Update(done);
    return !context.interruption->happened();
  };
}

// Returns the files' names.
std::string SourceOf(const FitCommandOptions& options, const std::vector<fit::MeasuredFile>& files) {
  std::vector<std::string> names;
  names.reserve(files.size());
  for (const fit::MeasuredFile& file : files) names.push_back(file.name);
  return SourceOf(options, names);  // without their folders
}

int WriteJoint(const FitCommandOptions& options, const fit::SceneLungs& lungs, const fit::JointFit& found,
               const std::string& source) {
  if (!options.out.empty()) {
    const absl::Status status = WriteJointScene(options.out, lungs, found, options.fit, source, options.show_landmarks);
    if (!status.ok()) return Fail(status);
    std::cerr << "wrote " << options.out << "\n";
  }
  if (options.residuals.empty()) return kOk;
  if (const absl::Status status = WriteResiduals(options.residuals, found.motion); !status.ok()) return Fail(status);
  std::cerr << "wrote " << options.residuals << "\n";
  return kOk;
}

// Fits live parameters by simulated breaths.
int FitParameters(const Context& context, const FitCommandOptions& options) {
  const auto files = ReadMeasured(options.data);
  if (!files.ok()) return Fail(files.status());
  const auto evidence = fit::ParseEvidence(*files);
  if (!evidence.ok()) return Fail(evidence.status());
  const absl::StatusOr<v1::SceneSource> scene = ReadScene(options.scene);
  if (!scene.ok()) return Fail(scene.status());
  absl::StatusOr<SimulatedFit> found = absl::UnknownError("");
  {
    Progress progress("fitting " + options.scene.scene, 1);
    const fit::FitProgress show = ShowOn(progress, context);
    found = FitSimulation(context, *scene, options.scene.scene, *evidence, options.simulated, options.fit,
                          options.data_dir, [&](double done, const std::string& stage) { return show(done, stage); });
  }
  if (!found.ok()) return FailFit(context, found.status());
  const std::string source = SourceOf(options, *files);
  PrintSimulated(context, *found, source);
  if (options.out.empty()) return kOk;
  if (const absl::Status status = WriteSimulatedScene(options.out, *found, source); !status.ok()) return Fail(status);
  std::cerr << "wrote " << options.out << "\n";
  return kOk;
}

// Fits to several kinds of data together.
int FitAll(const Context& context, const FitCommandOptions& options) {
  const auto files = ReadMeasured(options.data);
  if (!files.ok()) return Fail(files.status());
  const auto evidence = fit::ParseEvidence(*files);
  if (!evidence.ok()) return Fail(evidence.status());
  const absl::StatusOr<v1::SceneSource> scene = ReadScene(options.scene);
  if (!scene.ok()) return Fail(scene.status());
  const auto lungs = ReadSceneLungs(*scene, options.data_dir);
  if (!lungs.ok()) return FailFit(context, lungs.status());
  absl::StatusOr<fit::JointFit> found = absl::UnknownError("");
  {
    Progress progress("fitting " + options.scene.scene, 1);
    found = fit::FitJointly(lungs->templates, *evidence, options.fit, ShowOn(progress, context));
  }
  if (!found.ok()) return FailFit(context, found.status());
  PrintDoubts(found->motion.registered);
  if (context.json()) {
    PrintJson(JointFitJson(*found, options.fit));
  } else if (context.output == Output::kCsv) {
    PrintJointFitCsv(*found);
  } else {
    PrintJointFit(*found, options.fit);
  }
  return WriteJoint(options, *lungs, *found, SourceOf(options, *files));
}

// Fits to landmarks of several times, by a column of their file.
int FitPhases(const Context& context, const FitCommandOptions& options) {
  if (const std::string fault = JointUsageFault(options); !fault.empty()) {
    return Fail(absl::InvalidArgumentError(fault));
  }
  return FitAll(context, options);
}

int FitLandmarks(const Context& context, const FitCommandOptions& options) {
  const auto landmarks = fit::ReadLandmarks(options.data.landmarks);
  if (!landmarks.ok()) return Fail(landmarks.status());
  if (landmarks->phase.size() > 0) return FitPhases(context, options);
  const absl::StatusOr<v1::SceneSource> scene = ReadScene(options.scene);
  if (!scene.ok()) return Fail(scene.status());
  const auto lungs = ReadSceneLungs(*scene, options.data_dir);
  if (!lungs.ok()) return FailFit(context, lungs.status());
  absl::StatusOr<fit::MotionFit> found = absl::UnknownError("");
  {
    Progress progress("fitting " + options.scene.scene, 1);
    found = fit::FitMotion(lungs->templates, *landmarks, options.fit, ShowOn(progress, context));
  }
  if (!found.ok()) return FailFit(context, found.status());
  PrintDoubts(found->registered);
  if (context.json()) {
    PrintJson(FitJson(*found, options.fit));
  } else if (context.output == Output::kCsv) {
    PrintFitCsv(*found);
  } else {
    PrintFit(*found, options.fit);
  }
  if (!options.out.empty()) {
    const absl::Status status = WriteFittedScene(options.out, *lungs, *found, options.fit,
                                                 SourceOf(options, options.data.landmarks), options.show_landmarks);
    if (!status.ok()) return Fail(status);
    std::cerr << "wrote " << options.out << "\n";
  }
  if (options.residuals.empty()) return kOk;
  if (const absl::Status status = WriteResiduals(options.residuals, *found); !status.ok()) return Fail(status);
  std::cerr << "wrote " << options.residuals << "\n";
  return kOk;
}

// Predicts the motion of the points, each number of the prior varying independently.
absl::StatusOr<Expected> Expect(const fit::Person& person, const fit::PeopleMotion& people,
                                const FitCommandOptions& options) {
  Expected expected;
  expected.amplitudes = person.amplitudes();
  expected.people = people.people;
  if (options.descent) {
    expected.prediction = fit::PredictFromDescent(person, people, *options.descent / 1000);
    return expected;
  }
  const auto prediction = fit::PredictFromVolume(person, people, *options.tidal_volume / 1000);
  if (!prediction.ok()) return prediction.status();
  expected.prediction = *prediction;
  return expected;
}

// Writes the expected breath as a scene, if that is asked for.
absl::Status WriteExpectedPerson(const FitCommandOptions& options, const fit::SceneLungs& lungs,
                                 const fit::Person& person, const fit::Prediction& prediction) {
  if (options.out.empty()) return absl::OkStatus();
  const std::string number = options.descent ? absl::StrFormat("a descent of %.1f mm", *options.descent)
                                             : absl::StrFormat("a tidal volume of %.2f l", *options.tidal_volume);
  absl::Status written =
      WriteExpectedScene(options.out, lungs, person, prediction, number, SourceOf(options, options.data.exhale));
  if (written.ok()) std::cerr << "wrote " << options.out << "\n";
  return written;
}

int PrintAndWriteExpected(const Context& context, const FitCommandOptions& options, const fit::Person& person,
                          const Points& exhale, Expected expected) {
  const fit::MotionBand band = fit::BandAt(person, expected.prediction, exhale);
  expected.regions = fit::BandByRegion(person, exhale, band);
  if (context.json()) {
    PrintJson(ExpectedJson(expected));
  } else if (context.output == Output::kCsv) {
    PrintExpectedCsv(expected);
  } else {
    PrintExpected(expected);
  }
  if (options.expected.empty()) return kOk;
  const absl::Status status = WriteExpected(options.expected, exhale, band.motion, band.spread);
  if (!status.ok()) return Fail(status);
  std::cerr << "wrote " << options.expected << "\n";
  return kOk;
}

int FitOneNumber(const Context& context, const FitCommandOptions& options) {
  const auto points = fit::ReadLandmarks(options.data.exhale);
  if (!points.ok()) return Fail(points.status());
  const absl::StatusOr<v1::SceneSource> scene = ReadScene(options.scene);
  if (!scene.ok()) return Fail(scene.status());
  const auto lungs = ReadSceneLungs(*scene, options.data_dir);
  if (!lungs.ok()) return FailFit(context, lungs.status());
  const auto registered = fit::RegisterLungs(lungs->templates, points->exhale);
  if (!registered.ok()) return FailFit(context, registered.status());
  PrintDoubts(*registered);
  const auto person = WithProgress("solving", [&] {
    return fit::Person::Make(lungs->templates, *registered, BreathAmplitudes(options.fit.numbers),
                             options.fit.elasticity, [&] { return context.interruption->happened(); });
  });
  if (!person.ok()) return FailFit(context, person.status());
  auto expected = Expect(*person, fit::ShippedPeople(options.fit.numbers), options);
  if (!expected.ok()) return FailFit(context, expected.status());
  if (const absl::Status status = WriteExpectedPerson(options, *lungs, *person, expected->prediction); !status.ok()) {
    return Fail(status);
  }
  return PrintAndWriteExpected(context, options, *person, points->exhale, *std::move(expected));
}

int FitPerson(const Context& context, const FitCommandOptions& options) {
  if (const std::string fault = FitUsageFault(options); !fault.empty()) {
    return Fail(absl::InvalidArgumentError(fault));
  }
  if (!options.simulated.parameters.empty()) return FitParameters(context, options);
  if (HasOtherKinds(options.data)) return FitAll(context, options);
  return options.data.landmarks.empty() ? FitOneNumber(context, options) : FitLandmarks(context, options);
}

absl::Status CheckSceneFile(const std::string& file) {
  if (std::filesystem::path(file).extension() == ".textproto") return absl::OkStatus();
  return absl::InvalidArgumentError("a scene's file is NAME.textproto");
}

absl::Status CheckSource(const std::string& text) {
  constexpr size_t kLongest = 500;
  const bool printable = std::all_of(text.begin(), text.end(), [](unsigned char c) { return c >= 0x20 && c < 0x7f; });
  if (printable && text.size() <= kLongest) return absl::OkStatus();
  return absl::InvalidArgumentError("a source is at most 500 characters of ASCII");
}

void AddExhale(CLI::App& command, std::vector<std::string>& files) {
  CLI::Option* option = command.add_option(
      "--exhale", files, "points in the lungs at end exhale (.csv with x,y,z, .fcsv, .mrk.json) [mm, LPS]");
  option->expected(1);
}

void AddFiles(CLI::App& command, FitCommandOptions& options) {
  constexpr int kMostFiles = 20;
  const auto add = [&command](const char* name, std::vector<std::string>& files, const char* help) {
    command.add_option(name, files, help)->expected(1, kMostFiles)->allow_extra_args(false);
  };
  add("--landmarks", options.data.landmarks,
      "landmark pairs of end exhale and end inhale: one .csv, or two files of points (.fcsv, .mrk.json); other phases "
      "by a column phase or FILE@PHASE (0 exhale, 1 inhale, 2 exhale)");
  add("--surface", options.data.surfaces,
      "surface of the diaphragm (.stl, .obj, .ply, .vtk, .vtp) [mm, LPS], FILE@inhale; FILE@exhale beside it takes the "
      "template's shape out");
  add("--lung-surface", options.data.lung_surfaces, "the same of the lungs");
  add("--volume", options.data.volumes, "spirogram: .csv with time_s,volume_l");
  add("--m-mode", options.data.m_modes,
      "displacement of a dome over time, downwards: .csv with time_s,displacement_mm; FILE@right or FILE@left");
  add("--markers", options.data.markers,
      "markers on the chest wall: .csv with name,rest_x,...,moved_z, or tracks NAME_x,NAME_y,NAME_z [mm, LPS]");
  command
      .add_option("--error", options.data.errors,
                  "standard error of a kind of data [mm, l]: landmarks=1.5, surface=6 (2.5 with a surface at exhale), "
                  "lung-surface=6, volume=0.05, m-mode=2, markers=4")
      ->check(ParsedBy(&CheckError))
      ->allow_extra_args(false);
  AddExhale(command, options.data.exhale);
  command.add_option("--residuals", options.residuals, "write measured, predicted and residual vectors (.csv, .vtp)");
  command.add_option("--expected", options.expected,
                     "write the expected motion of the points and its spread (.csv, .vtp)");
  command.add_option("--out", options.out, "write the person's lungs and breath as a scene (.textproto)")
      ->check(ParsedBy(&CheckSceneFile));
  command.add_option("--source", options.source, "what the points are of, for the scene (default: the files' names)")
      ->check(ParsedBy(&CheckSource));
  command.add_flag("--show-landmarks", options.show_landmarks,
                   "add the landmarks of the unseen half to the scene, with what the fit leaves");
}

}  // namespace

CommandFunction SetUpRegister(CLI::App& command) {
  const auto options = std::make_shared<RegisterOptions>();
  AddScene(command, options->scene);
  AddExhale(command, options->exhale);
  command
      .add_option(
          "--surface", options->surfaces,
          "a surface at end exhale [mm, LPS]: lung-right=FILE, lung-left=FILE, and diaphragm=FILE to be judged by")
      ->check(ParsedBy(&CheckStructure))
      ->allow_extra_args(false);
  command.add_option("--volume", options->volume,
                     "label volume at end exhale (NIfTI, DICOM Segmentation) with the lungs");
  AddLabels(command, options->labels);
  AddDataFolder(command, options->data_dir);
  command.add_option("--out", options->out, "write the person's lungs to this folder (lung-right.obj, lung-left.obj)");
  return Bind(&RegisterPerson, options);
}

CommandFunction SetUpFit(CLI::App& command) {
  const auto options = std::make_shared<FitCommandOptions>();
  AddScene(command, options->scene);
  AddFiles(command, *options);
  command.add_option("--descent", options->descent, "motion of the lungs' lowest fifth downwards [mm], with --exhale")
      ->check(NumberIn(0, 150));
  command.add_option("--tidal-volume", options->tidal_volume, "change of the lungs' volume [l], with --exhale")
      ->check(NumberIn(0, 8));
  command
      .add_option("--parameters", options->simulated.parameters,
                  "fit live parameters of the scene by simulated breaths, such as diaphragm_activation, "
                  "intercostal_activation, lung_compliance:0.1:0.3")
      ->delimiter(',')
      ->check(ParsedBy([](const std::string& text) { return calibrate::ReadVaried(text).status(); }))
      ->allow_extra_args(false);
  command.add_option("--preset", options->simulated.preset, "the preset that --parameters begins with")
      ->capture_default_str();
  AddParameters(command, options->simulated.settings);
  command.add_option("--modes", options->fit.numbers, "numbers that a breath is made of")->capture_default_str();
  command.add_option("--split", options->fit.split, "seed of the random half that is fitted")
      ->check(NumberIn(0, 4294967295))
      ->capture_default_str();
  command.add_flag("--assimilate", options->fit.assimilate,
                   "add the smallest elastic deformation through the fitting half");
  AddDataFolder(command, options->data_dir);
  return Bind(&FitPerson, options);
}

}  // namespace phrenic::client
