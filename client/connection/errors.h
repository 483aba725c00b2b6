// Errors as the user sees them: a message on standard error and an exit code.
#ifndef PHRENIC_CLIENT_CONNECTION_ERRORS_H_
#define PHRENIC_CLIENT_CONNECTION_ERRORS_H_

#include <grpcpp/support/status.h>

#include <string>

#include "absl/status/status.h"
#include "client/connection/context.h"

namespace phrenic::client {

// Returns "phrenic:", the prefix of every error message; red on a terminal.
std::string ErrorPrefix();

// Prints the error, its remedy and the next command to type on standard error. Returns the exit code: kInterrupted
// after Ctrl-C, kUnreachable for UNAVAILABLE, kNotAllowed for PERMISSION_DENIED and UNAUTHENTICATED, kFailed otherwise.
// Requires: the status is not OK.
int Fail(const Context& context, const grpc::Status& status);
// Prints the error on standard error. Returns kFailed.
int Fail(const absl::Status& status);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CONNECTION_ERRORS_H_
