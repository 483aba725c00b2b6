// The forces on a body of a session as it is now.
#ifndef PHRENIC_SERVER_SESSION_PRESENT_FORCES_H_
#define PHRENIC_SERVER_SESSION_PRESENT_FORCES_H_

#include "absl/status/statusor.h"
#include "phrenic/v1/frames.pb.h"
#include "server/session/table.h"

namespace phrenic::session {

// Takes a copy of the state between two steps and works them out in the calling thread. INVALID_ARGUMENT with what
// there is where there is no such deformable body, vertex or kind; NOT_FOUND, FAILED_PRECONDITION of Table::Find and
// Session::MakeFork. Any thread may call.
absl::StatusOr<v1::GetForcesResponse> ReadForces(const Table& table, const v1::GetForcesRequest& request);

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_PRESENT_FORCES_H_
