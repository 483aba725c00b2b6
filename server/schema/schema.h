// Reads the meaning of fields (phrenic/v1/options.proto) off any message: ranges, defaults, required fields.
#ifndef PHRENIC_SERVER_SCHEMA_SCHEMA_H_
#define PHRENIC_SERVER_SCHEMA_SCHEMA_H_

#include <google/protobuf/message.h>

#include <string>
#include <string_view>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "phrenic/v1/parameters.pb.h"
#include "phrenic/v1/scene.pb.h"

namespace phrenic::schema {

// Checks every set number against its Quantity and every field marked required, through all nested messages.
// INVALID_ARGUMENT with the path: "forces[2].springs.stiffness: -5 is outside 0 to 1e+09 N/m". Enums outside their
// values, NaN and infinity are refused too.
absl::Status Validate(const google::protobuf::Message& message);

// Gives every field that is not set and has a Quantity or Toggle its default, through all nested messages that are set;
// automatic quantities stay unset.
void FillDefaults(google::protobuf::Message* message);

// Sets one field of the parameters from text, "breath_force" and "1.5", "apply_muscles" and "off". INVALID_ARGUMENT
// names the field, the allowed range, and the names there are when there is no such one.
absl::Status SetParameter(std::string_view name, std::string_view value, v1::Parameters* parameters);

// Parses text-format `text` into `message` and validates it. `name` is for errors: "name:line:column: ...".
absl::Status ParseText(std::string_view name, const std::string& text, google::protobuf::Message* message);

// Parses a text-format scene, fills no defaults, validates. `name` is for errors: "name:line:column: ...".
absl::StatusOr<v1::Scene> ParseScene(std::string_view name, const std::string& text);

}  // namespace phrenic::schema

#endif  // PHRENIC_SERVER_SCHEMA_SCHEMA_H_
