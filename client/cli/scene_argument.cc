#include "client/cli/scene_argument.h"

#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "client/files/whole_file.h"
#include "server/mechanics/compile/presets.h"
#include "server/schema/fields.h"
#include "server/schema/schema.h"

namespace phrenic::client {
namespace {

// A body's name may contain colons, so only the last two separate.
absl::StatusOr<v1::Pull> ReadPull(const std::string& text) {
  const absl::Status fault = absl::InvalidArgumentError(
      absl::StrCat("\"", text, "\" is not of the form BODY:VERTEX:X,Y,Z, such as diaphragm:812:0,0,1"));
  const size_t second = text.rfind(':');
  if (second == std::string::npos || second == 0) return fault;
  const size_t first = text.rfind(':', second - 1);
  if (first == std::string::npos) return fault;
  const std::vector<std::string> force = absl::StrSplit(text.substr(second + 1), ',');
  int vertex = 0;
  double x = 0, y = 0, z = 0;
  if (!absl::SimpleAtoi(text.substr(first + 1, second - first - 1), &vertex) || force.size() != 3 ||
      !absl::SimpleAtod(force[0], &x) || !absl::SimpleAtod(force[1], &y) || !absl::SimpleAtod(force[2], &z)) {
    return fault;
  }
  v1::Pull pull;
  pull.set_body(text.substr(0, first));
  pull.set_vertex(vertex);
  pull.mutable_force()->set_x(x);
  pull.mutable_force()->set_y(y);
  pull.mutable_force()->set_z(z);
  return pull;
}

// Parses texts "name=value", each of which `set` sets in a message.
template <typename Message>
absl::StatusOr<Message> ReadPairs(const std::vector<std::string>& pairs, const char* example,
                                  absl::Status (*set)(std::string_view, std::string_view, Message*)) {
  Message message;
  for (const std::string& pair : pairs) {
    const size_t equals = pair.find('=');
    if (equals == std::string::npos) {
      return absl::InvalidArgumentError(
          absl::StrCat("\"", pair, "\" is not of the form name=value, such as ", example));
    }
    absl::Status status = set(pair.substr(0, equals), pair.substr(equals + 1), &message);
    if (!status.ok()) return status;
  }
  return message;
}

}  // namespace

absl::StatusOr<v1::SceneSource> ReadScene(const SceneOptions& options) {
  const std::string& scene = options.scene;
  v1::SceneSource source;
  if (!options.physique.empty()) {
    absl::StatusOr<v1::Physique> physique = ReadPhysique(options.physique);
    if (!physique.ok()) return physique.status();
    *source.mutable_physique() = *std::move(physique);
  }
  if (options.resolution_mm != 0) source.set_resolution_mm(options.resolution_mm);
  if (!absl::StrContains(scene, "/") && !absl::EndsWith(scene, ".textproto")) {
    source.set_name(scene);
    return source;
  }
  const absl::StatusOr<std::string> text = ReadWhole(scene, "the scene file");
  if (!text.ok()) return text.status();
  absl::StatusOr<v1::Scene> parsed = schema::ParseScene(scene, *text);
  if (!parsed.ok()) return parsed.status();
  *source.mutable_scene() = *std::move(parsed);
  return source;
}

absl::StatusOr<google::protobuf::RepeatedPtrField<v1::Pull>> ReadPulls(const std::vector<std::string>& pulls) {
  google::protobuf::RepeatedPtrField<v1::Pull> list;
  for (const std::string& text : pulls) {
    const absl::StatusOr<v1::Pull> pull = ReadPull(text);
    if (!pull.ok()) return pull.status();
    *list.Add() = *pull;
  }
  return list;
}

absl::StatusOr<v1::Parameters> ReadSettings(const std::vector<std::string>& settings) {
  return ReadPairs<v1::Parameters>(settings, "breath_force=1.5", &schema::SetParameter);
}

absl::StatusOr<v1::Physique> ReadPhysique(const std::vector<std::string>& numbers) {
  return ReadPairs<v1::Physique>(numbers, "age=70", &schema::SetPhysique);
}

absl::StatusOr<v1::Parameters> ChosenParameters(const Model& model, const std::string& preset,
                                                const std::vector<std::string>& settings) {
  const absl::StatusOr<v1::Parameters> found = FindPreset(model.scene, preset);
  if (!found.ok()) return found.status();
  const absl::StatusOr<v1::Parameters> set = ReadSettings(settings);
  if (!set.ok()) return set.status();
  v1::Parameters parameters = model.parameters;
  parameters.MergeFrom(*found);
  parameters.MergeFrom(*set);
  return parameters;
}

}  // namespace phrenic::client
