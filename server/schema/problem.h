// The first error in a message, and the field that has it.
#ifndef PHRENIC_SERVER_SCHEMA_PROBLEM_H_
#define PHRENIC_SERVER_SCHEMA_PROBLEM_H_

#include <google/protobuf/message.h>

#include <optional>
#include <string>
#include <vector>

namespace phrenic::schema {

// One step of a path into a message. `index` is -1 for a field that is not repeated, and for a repeated field as a
// whole.
struct PathStep {
  const google::protobuf::FieldDescriptor* field = nullptr;
  int index = -1;
};

struct Problem {
  std::vector<PathStep> path;  // outermost first; ends at the field itself
  std::string what;            // "-5 is outside 0 to 1e+09 N/m"
};

// Returns the first invalid field in the order of the schema, depth first; nullopt if the message is valid.
std::optional<Problem> FindProblem(const google::protobuf::Message& message);

// Returns "forces[2].springs.stiffness".
std::string FormatPath(const std::vector<PathStep>& path);

}  // namespace phrenic::schema

#endif  // PHRENIC_SERVER_SCHEMA_PROBLEM_H_
