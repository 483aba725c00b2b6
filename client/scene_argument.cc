#include "client/scene_argument.h"

#include <google/protobuf/descriptor.h>

#include <fstream>
#include <sstream>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/table.h"
#include "server/schema/fields.h"
#include "server/schema/schema.h"

namespace phrenic::client {

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

std::string ParameterHelp() {
  Table table({"parameter", "unit", "range", "default", "meaning"});
  const google::protobuf::Descriptor& type = *v1::Parameters::descriptor();
  for (int f = 0; f < type.field_count(); ++f) {
    const google::protobuf::FieldDescriptor& field = *type.field(f);
    if (field.options().HasExtension(v1::toggle)) {
      const v1::Toggle& toggle = field.options().GetExtension(v1::toggle);
      table.Add({field.name(), "", "on, off", toggle.default_value() ? "on" : "off", toggle.help()});
      continue;
    }
    if (field.options().HasExtension(v1::choice)) {
      const v1::Choice& choice = field.options().GetExtension(v1::choice);
      table.Add({field.name(), "", schema::ChoiceNames(*field.enum_type()),
                 schema::ChoiceName(*field.enum_type()->FindValueByNumber(choice.default_value())), choice.help()});
      continue;
    }
    const v1::Quantity& quantity = field.options().GetExtension(v1::quantity);
    table.Add({field.name(), quantity.unit() == "1" ? "" : quantity.unit(),
               absl::StrFormat("%g to %g", quantity.minimum(), quantity.maximum()),
               quantity.automatic() ? "automatic" : absl::StrFormat("%g", quantity.default_value()), quantity.help()});
  }
  std::ostringstream text;
  table.Print(text);
  return text.str();
}

}  // namespace phrenic::client
