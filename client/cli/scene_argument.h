// The arguments of commands that make a session: a scene, parameters and pulls.
#ifndef PHRENIC_CLIENT_CLI_SCENE_ARGUMENT_H_
#define PHRENIC_CLIENT_CLI_SCENE_ARGUMENT_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "phrenic/v1/session.pb.h"
#include "server/mechanics/model.h"

namespace phrenic::client {

struct SceneOptions {
  std::string scene;                       // a name of the catalogue, or a path: contains a slash or ends in .textproto
  double resolution_mm = 0;                // edge length of generated bodies [mm]; 0: the scene's own
  std::vector<std::string> physique = {};  // "name=value" of message Physique, in place of the scene's
};

// Returns the scene's name, or the scene read from its file. Errors name the file and the line.
absl::StatusOr<v1::SceneSource> ReadScene(const SceneOptions& options);

// Parses pulls "BODY:VERTEX:X,Y,Z" with the force in [N]. INVALID_ARGUMENT quotes the text.
absl::StatusOr<google::protobuf::RepeatedPtrField<v1::Pull>> ReadPulls(const std::vector<std::string>& pulls);

// Parses parameters "name=value". INVALID_ARGUMENT names the parameter or quotes the text.
absl::StatusOr<v1::Parameters> ReadSettings(const std::vector<std::string>& settings);

// Parses numbers of a body "name=value". INVALID_ARGUMENT names the number or quotes the text.
absl::StatusOr<v1::Physique> ReadPhysique(const std::vector<std::string>& numbers);

// Returns the parameters of a model with a preset of its scene (empty: none), and on top of it the settings. The errors
// of FindPreset and ReadSettings.
absl::StatusOr<v1::Parameters> ChosenParameters(const Model& model, const std::string& preset,
                                                const std::vector<std::string>& settings);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CLI_SCENE_ARGUMENT_H_
