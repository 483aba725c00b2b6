// What is compared, read: files parsed, bodies of sessions asked for.
#ifndef PHRENIC_SERVER_COMPARE_COMPARED_H_
#define PHRENIC_SERVER_COMPARE_COMPARED_H_

#include <optional>
#include <string>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "phrenic/v1/compare.pb.h"
#include "server/meshio/motion.h"

namespace phrenic::compare {

// Gives a body of a session as it is now [m] and fills in which state that is.
using BodySource = absl::FunctionRef<absl::StatusOr<Mesh>(const v1::SessionBody& body, v1::ComparedState& state)>;

struct Compared {
  std::string name;  // for messages
  meshio::Motion motion;
  std::optional<v1::ComparedState> state;  // of a body of a session
};

struct ComparedPair {
  Compared a, b;
};

// A and B of a validated request. A file's motion is one state alone where its `time` says so, or else the time of the
// other surface where that is a body of a session. INVALID_ARGUMENT "name:line: ..." for a file that cannot be read, or
// naming the field; FAILED_PRECONDITION for a motion that has no state at that time; `bodies`' own errors.
absl::StatusOr<ComparedPair> ReadPair(const v1::CompareRequest& request, BodySource bodies);

}  // namespace phrenic::compare

#endif  // PHRENIC_SERVER_COMPARE_COMPARED_H_
