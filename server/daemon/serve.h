// Serves until a signal comes.
#ifndef PHRENIC_SERVER_DAEMON_SERVE_H_
#define PHRENIC_SERVER_DAEMON_SERVE_H_

#include "server/daemon/flags.h"

namespace phrenic::daemon {

inline constexpr int kOk = 0, kFailed = 1, kUsage = 2;

// The exit code: 1 where it cannot serve, and says why on standard error.
int Serve(const Flags& flags);

}  // namespace phrenic::daemon

#endif  // PHRENIC_SERVER_DAEMON_SERVE_H_
