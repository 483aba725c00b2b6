// `phrenic patient`: makes a breathing thorax from a label volume or from surface files.
#include "server/imaging/patient/patient.h"

#include <unistd.h>

#include <filesystem>
#include <iostream>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/cli/argument_kinds.h"
#include "client/cli/shared_options.h"
#include "client/commands/commands.h"
#include "client/connection/errors.h"
#include "client/files/patient_files.h"
#include "client/files/whole_file.h"
#include "client/print/output.h"
#include "client/terminal/progress.h"
#include "server/imaging/labels/label_input.h"
#include "server/imaging/surfaces/surface_scene.h"
#include "server/schema/id.h"
#include "server/schema/places.h"
#include "server/schema/schema.h"
#include "server/session/meshes.h"

namespace phrenic::client {
namespace {

struct PatientOptions {
  std::vector<std::string> volumes;
  std::vector<std::string> labels;  // maps, or FILE=MAP
  std::string data;                 // folder of the surface files
  std::string out, name = "patient";
  double edge_length = 4;  // [mm]
  int vertices = 20000;
  double tendon_share = 0.17;
  bool no_fill = false;  // leave out what the volume does not show
  bool anyway = false;   // also if the volume is not usable
  bool serve = false;
  std::string web = "127.0.0.1:8080";
};

// Returns the generated thorax's scene, the template of patients' scenes.
absl::StatusOr<v1::Scene> ReadTemplate() {
  const std::string path = Installed("scenes", PHRENIC_SCENES_DIR) + "/thorax.textproto";
  const absl::StatusOr<std::string> text = ReadWhole(path, "the template of patients' scenes");
  if (!text.ok()) return text.status();
  return schema::ParseScene(path, *text);
}

absl::StatusOr<imaging::MapChoices> ReadChoices(const std::vector<std::string>& labels) {
  imaging::MapChoices choices;
  for (const std::string& text : labels) {
    const std::size_t at = text.rfind('=');
    if (at == std::string::npos && choices.all.empty()) {
      choices.all = text;
    } else if (at == std::string::npos || !choices.by_file.emplace(text.substr(0, at), text.substr(at + 1)).second) {
      return absl::InvalidArgumentError(
          absl::StrCat("--labels ", text, ": give one map for all files, and FILE=MAP once for a file of another map"));
    }
  }
  return choices;
}

absl::StatusOr<imaging::Patient> ReadAndMakePatient(const PatientOptions& options) {
  const absl::StatusOr<imaging::MapChoices> choices = ReadChoices(options.labels);
  if (!choices.ok()) return choices.status();
  const absl::StatusOr<v1::Scene> scene_template = ReadTemplate();
  if (!scene_template.ok()) return scene_template.status();
  Progress progress("making " + options.name, 1);
  progress.SetDetail("reading");
  progress.Update(0);
  absl::StatusOr<imaging::LabelInput> labels = imaging::ReadLabelInput(options.volumes, *choices);
  if (!labels.ok()) return labels.status();
  imaging::LabelVolume& volume = labels->volume;
  if (labels->meanings.labels().empty()) {
    return absl::InvalidArgumentError(
        absl::StrCat(options.volumes.front(),
                     ": none of its label names is known: rename the labels as in totalsegmentator.textproto, give a "
                     "map of the names (--labels FILE), or --labels MAP, by whose numbers they are known"));
  }
  volume.names.clear();  // `meanings` has the numbers of those that are known
  if (!labels->remark.empty()) volume.remarks.push_back(labels->remark);
  const imaging::PatientOptions patient = {
      options.name, options.edge_length, {options.vertices, options.tendon_share}, !options.no_fill};
  return imaging::MakePatient(volume, labels->meanings, *scene_template, patient,
                              [&](double done, std::string_view stage) {
                                progress.SetDetail(std::string(stage));
                                progress.Update(done);
                                return true;
                              });
}

void PrintDiaphragm(const v1::DerivedDiaphragm& diaphragm) {
  std::cout << absl::StrFormat(
      "diaphragm: %d vertices, %.0f cm2 per layer; %.0f %% between organs, %.0f %% under one organ, %.0f %% on bone, "
      "%.0f %% in its own label, %.0f %% extrapolated\n",
      diaphragm.vertices(), diaphragm.area_cm2(), 100 * diaphragm.between_organs(), 100 * diaphragm.beside_one_organ(),
      100 * diaphragm.on_bone(), 100 * diaphragm.labelled(), 100 * diaphragm.extrapolated());
  for (const v1::ExtrapolatedSector& sector : diaphragm.sectors()) {
    std::cout << absl::StrFormat("  extrapolated: %s, %.0f %% of this sector\n", sector.where(), 100 * sector.share());
  }
}

const char* WordsOf(v1::ReadinessVerdict verdict) {
  if (verdict == v1::READINESS_VERDICT_READY) return "ready";
  return verdict == v1::READINESS_VERDICT_NOT_USABLE ? "not usable" : "usable with care";
}

void PrintReadiness(const v1::Readiness& readiness) {
  std::cout << "readiness: " << WordsOf(readiness.verdict()) << "\n";
  for (const v1::ReadinessFinding& finding : readiness.findings()) {
    std::cout << "  " << WordsOf(finding.verdict()) << ": " << finding.what() << "\n";
  }
}

void PrintPatient(const v1::PatientReport& report) {
  Table surfaces({"surface", "vertices", "ml", "label ml", "from"});
  for (const v1::PatientSurface& surface : report.surfaces()) {
    surfaces.Add({surface.body(), absl::StrCat(surface.vertices()), absl::StrFormat("%.1f", surface.volume_ml()),
                  absl::StrFormat("%.1f", surface.label_volume_ml()), surface.from_template() ? "template" : "volume"});
  }
  surfaces.Print(std::cout);
  Table ribs({"rib", "neck mm", "axis to midplane deg", "drop deg"});
  for (const v1::PatientRib& rib : report.ribs()) {
    ribs.Add({rib.body(), absl::StrFormat("%.1f", rib.neck_mm()), absl::StrFormat("%.0f", rib.axis_degrees()),
              absl::StrFormat("%.0f", rib.drop_degrees())});
  }
  ribs.Print(std::cout);
  PrintDiaphragm(report.diaphragm());
  for (const std::string& fallback : report.fallbacks()) std::cout << "fall-back: " << fallback << "\n";
  PrintReadiness(report.readiness());
}

// Replaces this process by a server that plays the patient. Returns only on failure.
int ServePatient(const PatientOptions& options) {
  std::error_code error;
  const std::string server =
      (std::filesystem::read_symlink("/proc/self/exe", error).parent_path() / "phrenicd").string();
  execl(server.c_str(), "phrenicd", "--data", options.out.c_str(), "--start", options.name.c_str(), "--web",
        options.web.c_str(), "--store", "none", nullptr);
  return Fail(absl::NotFoundError(absl::StrCat("cannot start ", server, ": build phrenicd, or omit --serve")));
}

int PrintNext(const PatientOptions& options, const std::string& data) {
  const std::string scene = SceneFile(options.out, options.name);
  std::cerr << "wrote " << scene << "; next:\n  phrenic run " << scene << " --data " << data << "\n";
  if (data == options.out) std::cerr << "  phrenicd --data " << data << " --start " << options.name << "\n";
  return kOk;
}

// Makes the scene of a person whose surfaces are files that another scene names.
int MakeFromSurfaces(const PatientOptions& options) {
  const std::string& file = options.volumes.front();
  const absl::StatusOr<std::string> text = ReadWhole(file, "the scene that names the surfaces");
  if (!text.ok()) return Fail(text.status());
  const absl::StatusOr<v1::Scene> surfaces = schema::ParseScene(file, *text);
  if (!surfaces.ok()) return Fail(surfaces.status());
  const absl::StatusOr<v1::Scene> scene_template = ReadTemplate();
  if (!scene_template.ok()) return Fail(scene_template.status());
  const std::string& data = options.data.empty() ? options.out : options.data;
  if (options.serve && data != options.out) {
    return Fail(absl::InvalidArgumentError(
        absl::StrCat("--serve: a server has one data folder, and the surfaces are in ", data, "; give --out ", data)));
  }
  const auto made = imaging::MakeSurfaceScene(session::MakeMeshSource(data), *surfaces, *scene_template, options.name);
  if (!made.ok()) return Fail(made.status());
  if (absl::Status status = WriteScene(options.out, made->scene); !status.ok()) return Fail(status);
  for (const imaging::Fallback& fallback : made->fallbacks) std::cout << "fall-back: " << fallback.text << "\n";
  return options.serve ? ServePatient(options) : PrintNext(options, data);
}

int MakePatient(const Context& context, const PatientOptions& options) {
  if (absl::Status status = schema::CheckId("--name", options.name); !status.ok()) return Fail(status);
  const bool surfaces = absl::EndsWith(options.volumes.front(), ".textproto");
  if (surfaces && options.volumes.size() == 1) return MakeFromSurfaces(options);
  const absl::StatusOr<imaging::Patient> patient = ReadAndMakePatient(options);
  if (!patient.ok()) return Fail(patient.status());
  const v1::Readiness& readiness = patient->report.readiness();
  const bool refused = readiness.verdict() == v1::READINESS_VERDICT_NOT_USABLE && !options.anyway;
  if (absl::Status status = refused ? absl::OkStatus() : WritePatient(options.out, *patient); !status.ok()) {
    return Fail(status);
  }
  if (context.json()) {
    std::cout << Json(patient->report) << "\n";
  } else {
    PrintPatient(patient->report);
  }
  if (refused) {
    return Fail(absl::FailedPreconditionError(
        absl::StrCat(options.volumes.front(), " is not usable, and nothing was written: ", readiness.findings(0).what(),
                     ". The report lists every finding; --anyway writes the patient nevertheless")));
  }
  if (options.serve) return ServePatient(options);
  return PrintNext(options, options.out);
}

}  // namespace

CommandFunction SetUpPatient(CLI::App& command) {
  const auto options = std::make_shared<PatientOptions>();
  command
      .add_option(
          "VOLUME", options->volumes,
          "labels as NIfTI (.nii, .nii.gz), DICOM Segmentation or RT Structure Set: a file, several files of one grid, "
          "their folder, or an archive (.zip, .tar); or a scene (.textproto) whose bodies are surface files")
      ->required();
  command
      .add_option(
          "--labels", options->labels,
          "map of the labels' numbers: totalsegmentator, vista3d, moose, cads, or a file NAME.textproto; FILE=MAP for "
          "one of several files; default: the names in the file, else the installed map that fits best")
      ->allow_extra_args(false);
  command.add_option("--data", options->data, "folder of the scene's surface files; without it, that of --out");
  command.add_option("--out", options->out, "data folder for the surfaces and the scene")->required();
  command.add_option("--name", options->name, "name of the scene: 1 to 64 of a-z, 0-9 and -")->capture_default_str();
  command
      .add_option("--edge-length", options->edge_length,
                  "edge length of the bones' triangles [mm]; the lungs' are 1.5 times as long")
      ->check(NumberIn(1.0, 20.0))
      ->capture_default_str();
  command.add_option("--vertices", options->vertices, "approximate number of vertices of the diaphragm")
      ->check(NumberIn(500, 200000))
      ->capture_default_str();
  command.add_option("--tendon-share", options->tendon_share, "fraction of the diaphragm's area that is tendon")
      ->check(NumberIn(0.05, 0.5))
      ->capture_default_str();
  command.add_flag("--no-fill", options->no_fill,
                   "leave out what the volume does not show, instead of filling it from the generated thorax");
  command.add_flag("--anyway", options->anyway, "write the patient also if the volume is not usable");
  CLI::Option* serve = command.add_flag("--serve", options->serve, "then start phrenicd with the viewer");
  command.add_option("--web", options->web, "address of the viewer")->needs(serve)->capture_default_str();
  return Bind(&MakePatient, options);
}

}  // namespace phrenic::client
