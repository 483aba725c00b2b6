// The first thing that is wrong with a message, and where.
#ifndef PHRENIC_SERVER_SCHEMA_PROBLEM_H_
#define PHRENIC_SERVER_SCHEMA_PROBLEM_H_

#include <google/protobuf/message.h>

#include <optional>
#include <string>
#include <vector>

namespace phrenic::schema {

// One step of a path into a message; `index` is -1 for a field that is not repeated.
struct PathStep {
  const google::protobuf::FieldDescriptor* field = nullptr;
  int index = -1;
};

struct Problem {
  std::vector<PathStep> path;  // outermost first; ends at the field itself
  std::string what;            // "-5 is outside 0 to 1e+09 N/m"
};

// Fields in the order of the schema, depth first; nothing where the message is right.
std::optional<Problem> FindProblem(const google::protobuf::Message& message);

// "forces[2].springs.stiffness".
std::string FormatPath(const std::vector<PathStep>& path);

}  // namespace phrenic::schema

#endif  // PHRENIC_SERVER_SCHEMA_PROBLEM_H_
