// Runs the server until SIGINT or SIGTERM.
#ifndef PHRENIC_SERVER_DAEMON_SERVE_H_
#define PHRENIC_SERVER_DAEMON_SERVE_H_

#include "server/daemon/flags.h"

namespace phrenic::daemon {

// Exit codes.
inline constexpr int kOk = 0, kFailed = 1, kUsage = 2;

// Returns the exit code: kFailed, with an error in the log, if the server cannot start. Blocks the signals in the
// calling thread; call it from main only.
int Serve(const Flags& flags);

}  // namespace phrenic::daemon

#endif  // PHRENIC_SERVER_DAEMON_SERVE_H_
