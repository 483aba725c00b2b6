#include "client/cli/shared_options.h"

#include "client/cli/argument_kinds.h"
#include "client/cli/schema_options.h"
#include "client/files/motion_file.h"
#include "phrenic/v1/export.pb.h"
#include "server/session/export/export_catalogue.h"

namespace phrenic::client {

void AddScene(CLI::App& command, SceneOptions& options) {
  command.add_option("SCENE", options.scene, "name of a scene, or a .textproto file")->required();
  AddResolution(command, options.resolution_mm);
  AddPhysique(command, options.physique);
}

void AddResolution(CLI::App& command, double& resolution_mm) {
  command.add_option("--resolution", resolution_mm, "edge length of generated bodies [mm]")->check(NumberIn(0.5, 50.0));
}

void AddPhysique(CLI::App& command, std::vector<std::string>& physique) {
  command
      .add_option("--physique", physique,
                  "a number of the generated body, such as sex=female or age=70; may be repeated")
      ->allow_extra_args(false);
}

void AddParameters(CLI::App& command, std::vector<std::string>& settings) {
  command.add_option("--set", settings, "sets a live parameter; may be repeated")->allow_extra_args(false);
}

void AddPreset(CLI::App& command, std::string& preset) {
  command.add_option("--preset", preset, "a preset of the scene; `phrenic describe` lists them");
}

void AddPulls(CLI::App& command, std::vector<std::string>& pulls) {
  command.add_option("--pull", pulls, "force [N] on a vertex; may be repeated")
      ->check(ParsedBy([](const std::string& text) { return ReadPulls({text}).status(); }))
      ->allow_extra_args(false);
}

void AddDataFolder(CLI::App& command, std::string& folder) {
  command.add_option("--data", folder, "folder with surface files and scenes/*.textproto")->envname("PHRENIC_DATA");
}

void AddJUnit(CLI::App& command, std::string& file) {
  command.add_option("--junit", file, "write the results of the checks to this file, as JUnit XML");
}

void AddLabels(CLI::App& command, std::string& labels) {
  command.add_option("--labels", labels, "map of the volume's numbers: totalsegmentator, or a file NAME.textproto")
      ->capture_default_str();
}

void AddSession(CLI::App& command, std::string& id) { command.add_option("SESSION", id)->required(); }

void AddRequestId(CLI::App& command, std::string& id) {
  command.add_option("--request-id", id,
                     "a repeated request with this id has no further effect and gets the same answer");
}

void AddUnit(CLI::App& command, const char* flag, double& unit_mm, const std::string& whose) {
  command.add_option(flag, unit_mm, "length of " + whose + " unit [mm]")
      ->check(NumberIn(1e-6, 1e6))
      ->capture_default_str();
}

void AddMotion(CLI::App& command, MotionOptions& motion) {
  const google::protobuf::Descriptor& request = *v1::CreateExportRequest::descriptor();
  const v1::Quantity& start = *schema::QuantityOf(*request.FindFieldByName("start"));
  command.add_option("--at,--from", motion.start, FieldHelp(request, "start"))
      ->check(NumberIn(start.minimum(), start.maximum()));
  CLI::Option* rate = command.add_option("--fps", motion.frames_per_second,
                                         "frames per simulated second (10; .glb: 24 per breath, .html: 80)");
  command.add_option("--every", motion.steps_per_frame, FieldHelp(request, "steps_per_frame"))
      ->check(NumberIn(1, 1'000'000))
      ->excludes(rate);
  command.add_option("--body", motion.bodies, "body or layer; may be repeated (all deformable ones)");
  CLI::Option* positions =
      command.add_flag("--positions", motion.positions, "store the vertices' positions (.msh, .pvd)");
  command
      .add_flag("--displacements", motion.displacements,
                "store the vertices' displacements from the first frame (.msh, .pvd)")
      ->excludes(positions);
}

std::string ExportEndings() {
  std::string names;
  for (const record::Format& format : session::ExportFormats()) {
    names += (names.empty() ? " (." : ", .") + format.name + (format.instant ? "*" : "");
  }
  return names + "; * for one instant)";
}

CLI::Validator ExportFile() {
  return ParsedBy(
      [](const std::string& file) { return record::FindFormat(session::ExportFormats(), FormatOf(file)).status(); });
}

CommandFunction SetUpWithSession(CLI::App& command, int (*run)(const Context&, const std::string&)) {
  const auto id = std::make_shared<std::string>();
  AddSession(command, *id);
  return Bind(run, id);
}

}  // namespace phrenic::client
