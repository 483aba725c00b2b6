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

// The exit codes of errors, the same for every command. INVALID_ARGUMENT: kUsage, what the user wrote is wrong: on the
// command line, in the environment, in the settings file or in a file that they name, whether this program or the
// server notices it. UNAVAILABLE: kUnreachable. PERMISSION_DENIED and UNAUTHENTICATED of a server: kNotAllowed. Others:
// kFailed, what was asked for could not be done.

// Prints the error, its remedy and the next command to type on standard error. Returns the exit code; kInterrupted
// after Ctrl-C. Requires: the status is not OK.
int Fail(const Context& context, const grpc::Status& status);
// Prints an error of this program on standard error. Returns kUsage or kFailed. Requires: the status is not OK.
int Fail(const absl::Status& status);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CONNECTION_ERRORS_H_
