#include "client/commands/command_tree.h"

#include "phrenic/v1/export.pb.h"
#include "server/schema/fields.h"
#include "server/session/export/export_catalogue.h"

namespace phrenic::client {

void CommandTree::AddScene(CLI::App* command, SceneOptions& options) {
  command->add_option("SCENE", options.scene, "name of a scene, or a .textproto file")->required();
  command->add_option("--resolution", options.resolution_mm, "edge length of generated bodies [mm]")
      ->check(NumberIn(0.5, 50.0));
}

void CommandTree::AddParameters(CLI::App* command, std::vector<std::string>& settings) {
  command->add_option("--set", settings, "name=value of a live parameter; may be repeated")->allow_extra_args(false);
}

void CommandTree::AddPulls(CLI::App* command, std::vector<std::string>& pulls) {
  command->add_option("--pull", pulls, "force [N] on a vertex, BODY:VERTEX:X,Y,Z; may be repeated")
      ->allow_extra_args(false);
}

void CommandTree::AddPreset(CLI::App* command, std::string& preset) {
  command->add_option("--preset", preset, "one of the scene's ways to breathe, as `phrenic describe` lists them");
}

std::string CommandTree::ExportEndings() {
  std::string names;
  for (const record::Format& format : session::ExportFormats()) {
    names += (names.empty() ? " (." : ", .") + format.name + (format.instant ? "*" : "");
  }
  return names + "; * of one instant)";
}

void CommandTree::AddMotion(CLI::App* command, MotionOptions& motion) {
  const google::protobuf::Descriptor& request = *v1::CreateExportRequest::descriptor();
  command->add_option("--at,--from", motion.start, FieldHelp(request, "start"));
  CLI::Option* rate =
      command->add_option("--fps", motion.frames_per_second, "frames a second in the file (10; .glb: 24 a breath)");
  command->add_option("--every", motion.steps_per_frame, FieldHelp(request, "steps_per_frame"))
      ->check(NumberIn(1, 1'000'000))
      ->excludes(rate);
  command->add_option("--body", motion.bodies, "body or layer; may be repeated (all deformable ones)");
  CLI::Option* positions = command->add_flag("--positions", motion.positions, "where vertices are (.msh, .pvd)");
  command->add_flag("--displacements", motion.displacements, "how far they are from the first frame (.msh, .pvd)")
      ->excludes(positions);
}

}  // namespace phrenic::client
