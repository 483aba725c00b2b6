// Applies the options of phrenic/v1/options.proto to any message: validates, fills in defaults, parses text. Stateless;
// thread-safe.
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

// Checks every set number against its Quantity and every required field, through all nested messages. Returns
// INVALID_ARGUMENT with the path: "forces[2].springs.stiffness: -5 is outside 0 to 1e+09 N/m". Refuses unknown enum
// values, NaN, infinity and text that is not UTF-8.
absl::Status Validate(const google::protobuf::Message& message);

// Brings a scene into the form that the compile step reads: older names of fields moved to the new ones, every
// `for_each` written out. Validates it. INVALID_ARGUMENT with the path into the scene as it was.
absl::Status Resolve(v1::Scene* scene);

// Sets every unset field that has a Quantity, Toggle or Choice to its default, through all nested messages that are
// set. Automatic quantities stay unset.
void FillDefaults(google::protobuf::Message* message);

// Sets one live parameter from text: "breath_force" and "1.5", "apply_muscles" and "off". INVALID_ARGUMENT names the
// field and the allowed range, or lists the parameters if there is none of that name.
absl::Status SetParameter(std::string_view name, std::string_view value, v1::Parameters* parameters);
// Sets one number of a body from text in the same way: "sex" and "female", "age" and "70".
absl::Status SetPhysique(std::string_view name, std::string_view value, v1::Physique* physique);

// Parses text-format `text` into `message`, moves older names of fields to the new ones and validates it. `name` is for
// errors: "name:line:column: ...".
absl::Status ParseText(std::string_view name, const std::string& text, google::protobuf::Message* message);

// Parses a text-format scene, resolves and validates it, and fills no defaults. `name` is for errors:
// "name:line:column: ...".
absl::StatusOr<v1::Scene> ParseScene(std::string_view name, const std::string& text);

}  // namespace phrenic::schema

#endif  // PHRENIC_SERVER_SCHEMA_SCHEMA_H_
