// The SCENE of a command line: a name of the catalogue, or a .textproto file.
#ifndef PHRENIC_CLIENT_CLI_SCENE_ARGUMENT_H_
#define PHRENIC_CLIENT_CLI_SCENE_ARGUMENT_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "phrenic/v1/session.pb.h"

namespace phrenic::client {

// A path (with a slash, or ending in .textproto) is read, parsed and checked here, so that errors name file and line.
// `resolution_mm` 0 leaves the scene's own.
absl::StatusOr<v1::SceneSource> ReadSceneArgument(const std::string& scene, double resolution_mm);

// Pulls from "BODY:VERTEX:X,Y,Z", the force in newtons; INVALID_ARGUMENT says what is wrong with which.
absl::StatusOr<google::protobuf::RepeatedPtrField<v1::Pull>> ReadPulls(const std::vector<std::string>& pulls);

// Parameters from "name=value" words; INVALID_ARGUMENT names the word.
absl::StatusOr<v1::Parameters> ReadSettings(const std::vector<std::string>& settings);

// All live parameters with unit, range, default and meaning.
struct ParameterRow {
  std::string name, unit, range, default_value, meaning;
};
std::vector<ParameterRow> ParameterRows();

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CLI_SCENE_ARGUMENT_H_
