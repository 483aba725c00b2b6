// Options that several commands have. Each function adds one option, or a group of them, to a command. Parsing writes
// to the given variables, which must outlive it.
#ifndef PHRENIC_CLIENT_CLI_SHARED_OPTIONS_H_
#define PHRENIC_CLIENT_CLI_SHARED_OPTIONS_H_

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "client/cli/command.h"
#include "client/cli/scene_argument.h"
#include "client/files/motion_file.h"

namespace phrenic::client {

// SCENE, --resolution and --physique.
void AddScene(CLI::App& command, SceneOptions& options);
void AddResolution(CLI::App& command, double& resolution_mm);
void AddPhysique(CLI::App& command, std::vector<std::string>& physique);
void AddParameters(CLI::App& command, std::vector<std::string>& settings);
void AddPreset(CLI::App& command, std::string& preset);
void AddPulls(CLI::App& command, std::vector<std::string>& pulls);
void AddDataFolder(CLI::App& command, std::string& folder);
void AddJUnit(CLI::App& command, std::string& file);
// --labels: the map of a label volume's numbers.
void AddLabels(CLI::App& command, std::string& labels);
// SESSION.
void AddSession(CLI::App& command, std::string& id);
void AddRequestId(CLI::App& command, std::string& id);
// `flag` sets the length of one unit of a file [mm]; `whose` is "FILE's".
void AddUnit(CLI::App& command, const char* flag, double& unit_mm, const std::string& whose);
// The options of a recording, apart from the file and its length.
void AddMotion(CLI::App& command, MotionOptions& motion);

// Returns the endings of the export formats: " (.msh, .obj*; * for one instant)".
std::string ExportEndings();
// Returns a check that the file name's extension is one of them.
CLI::Validator ExportFile();

// Returns a function that calls `run` with the options. The options live as long as the function.
template <typename Options>
CommandFunction Bind(int (*run)(const Context&, const Options&), std::shared_ptr<Options> options) {
  return [run, options = std::move(options)](const Context& context) { return run(context, *options); };
}

// Adds SESSION as the only argument and returns a function that calls `run` with it.
CommandFunction SetUpWithSession(CLI::App& command, int (*run)(const Context&, const std::string&));

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CLI_SHARED_OPTIONS_H_
