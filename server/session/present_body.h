// The present surface of a session's body.
#ifndef PHRENIC_SERVER_SESSION_PRESENT_BODY_H_
#define PHRENIC_SERVER_SESSION_PRESENT_BODY_H_

#include "absl/status/statusor.h"
#include "phrenic/v1/compare.pb.h"
#include "server/session/table.h"

namespace phrenic::session {

// Returns the surface of a body between two steps [m], with the body's regions and one more, named like the body, of
// all vertices. An empty body name means the largest body of tissue (skinning/tissue_bodies.h). Fills session, body,
// tick and time of `state`. INVALID_ARGUMENT if there is no such body with a surface, and lists those that there are;
// the errors of Table::Find and Session::ReadState. Thread-safe. Vertices are 3 x n, in the order of the body's mesh.
// The session steps on meanwhile.
absl::StatusOr<Mesh> FindPresentBody(const Table& table, const v1::SessionBody& body, v1::ComparedState& state);

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_PRESENT_BODY_H_
