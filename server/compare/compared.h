// Reads the two surfaces or motions of a comparison: parses files and fetches bodies of sessions.
#ifndef PHRENIC_SERVER_COMPARE_COMPARED_H_
#define PHRENIC_SERVER_COMPARE_COMPARED_H_

#include <optional>
#include <string>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "phrenic/v1/compare.pb.h"
#include "server/meshio/motion.h"

namespace phrenic::compare {

// Returns the current mesh of a session's body [m] and sets `state` to the session's tick and time.
using BodySource = absl::FunctionRef<absl::StatusOr<Mesh>(const v1::SessionBody& body, v1::ComparedState& state)>;

// One side of a comparison.
struct Compared {
  std::string name;                        // for messages
  meshio::Motion motion;                   // has no times if the surface does not move
  std::optional<v1::ComparedState> state;  // set for a session's body only
};

struct ComparedPair {
  Compared a, b;
};

// Reads A and B of a validated request. A file's motion is reduced to one state if its `time` is set, or if the other
// side is a body of a session; then the session's time is used. Errors: INVALID_ARGUMENT "name:line: ..." if a file
// cannot be read, or with the field's name; FAILED_PRECONDITION if a motion has no state at that time; those of
// `bodies`.
absl::StatusOr<ComparedPair> ReadPair(const v1::CompareRequest& request, BodySource bodies);

}  // namespace phrenic::compare

#endif  // PHRENIC_SERVER_COMPARE_COMPARED_H_
