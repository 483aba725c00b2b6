// The present forces on a session's body.
#ifndef PHRENIC_SERVER_SESSION_PRESENT_FORCES_H_
#define PHRENIC_SERVER_SESSION_PRESENT_FORCES_H_

#include "absl/status/statusor.h"
#include "phrenic/v1/frames.pb.h"
#include "server/session/table.h"

namespace phrenic::session {

// Evaluates the forces [N], by kind, on a copy of the state between two steps, in the calling thread. INVALID_ARGUMENT
// if there is no such body of tissue, vertex or kind, and lists those that there are; the errors of Table::Find and
// Session::MakeFork. Thread-safe. A sheet's layer gets the forces on its triangles, weighted. The sizes of one kind are
// little-endian float32 [N], one per vertex of the body. FAILED_PRECONDITION if the session has diverged.
absl::StatusOr<v1::GetForcesResponse> ReadForces(const Table& table, const v1::GetForcesRequest& request);

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_PRESENT_FORCES_H_
