#include "client/cli/scene_argument.h"

#include <google/protobuf/descriptor.h>

#include <fstream>
#include <sstream>

#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_split.h"
#include "server/schema/fields.h"
#include "server/schema/schema.h"

namespace phrenic::client {
namespace {

using google::protobuf::FieldDescriptor;

ParameterRow RowOf(const FieldDescriptor& field) {
  if (const v1::Toggle* toggle = schema::ToggleOf(field)) {
    return {field.name(), "", "on, off", toggle->default_value() ? "on" : "off", toggle->help()};
  }
  if (const v1::Choice* choice = schema::ChoiceOf(field)) {
    const google::protobuf::EnumDescriptor& type = *field.enum_type();
    // The names stand in the last column: there are too many of them for any other.
    return {field.name(), "", "a name", schema::ChoiceName(*type.FindValueByNumber(choice->default_value())),
            absl::StrCat(choice->help(), " One of ", schema::ChoiceNames(type), ".")};
  }
  const v1::Quantity& quantity = field.options().GetExtension(v1::quantity);
  return {field.name(), quantity.unit() == "1" ? "" : quantity.unit(),
          absl::StrFormat("%g to %g", quantity.minimum(), quantity.maximum()),
          quantity.automatic() ? "automatic" : absl::StrFormat("%g", quantity.default_value()), quantity.help()};
}

// A body's name may hold colons: the last two count.
absl::StatusOr<v1::Pull> ReadPull(const std::string& text) {
  const absl::Status fault = absl::InvalidArgumentError(
      absl::StrCat("\"", text, "\" is not of the form BODY:VERTEX:X,Y,Z, as in diaphragm:812:0,0,1"));
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

}  // namespace

absl::StatusOr<v1::SceneSource> ReadSceneArgument(const std::string& scene, double resolution_mm) {
  v1::SceneSource source;
  if (resolution_mm != 0) source.set_resolution_mm(resolution_mm);
  if (!absl::StrContains(scene, "/") && !absl::EndsWith(scene, ".textproto")) {
    source.set_name(scene);
    return source;
  }
  std::ifstream file(scene);
  if (!file) return absl::NotFoundError(absl::StrCat("cannot read the scene file ", scene, ": is the path right?"));
  std::stringstream text;
  text << file.rdbuf();
  absl::StatusOr<v1::Scene> parsed = schema::ParseScene(scene, text.str());
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
  v1::Parameters parameters;
  for (const std::string& setting : settings) {
    const size_t equals = setting.find('=');
    if (equals == std::string::npos) {
      return absl::InvalidArgumentError(
          absl::StrCat("\"", setting, "\" is not of the form name=value, as in breath_force=1.5"));
    }
    absl::Status status = schema::SetParameter(setting.substr(0, equals), setting.substr(equals + 1), &parameters);
    if (!status.ok()) return status;
  }
  return parameters;
}

std::vector<ParameterRow> ParameterRows() {
  std::vector<ParameterRow> rows;
  const google::protobuf::Descriptor& type = *v1::Parameters::descriptor();
  rows.reserve(static_cast<std::size_t>(type.field_count()));
  for (int f = 0; f < type.field_count(); ++f) rows.push_back(RowOf(*type.field(f)));
  return rows;
}

}  // namespace phrenic::client
