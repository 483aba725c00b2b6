// A body of a session as it is now.
#ifndef PHRENIC_SERVER_SESSION_PRESENT_BODY_H_
#define PHRENIC_SERVER_SESSION_PRESENT_BODY_H_

#include "absl/status/statusor.h"
#include "phrenic/v1/compare.pb.h"
#include "server/session/table.h"

namespace phrenic::session {

// The surface of a body between two steps [m], with the body's regions and one more of its name that has every vertex;
// `state` gets session, body, tick and time. INVALID_ARGUMENT lists the bodies that have a surface where there is no
// such one; NOT_FOUND, FAILED_PRECONDITION of Table::Find and Session::MakeFork. Any thread may call.
absl::StatusOr<Mesh> FindPresentBody(const Table& table, const v1::SessionBody& body, v1::ComparedState& state);

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_PRESENT_BODY_H_
