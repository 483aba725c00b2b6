// The server's log on standard error.
#ifndef PHRENIC_SERVER_DAEMON_LOG_H_
#define PHRENIC_SERVER_DAEMON_LOG_H_

#include <string>

namespace phrenic::daemon {

// Starts the log in the format "text", or "json" with one object per line: time, level, message. Messages contain no
// names that users give (sessions, callers, own scenes), because those may identify a patient. Call it once, before any
// log message; logging itself is thread-safe.
void StartLog(const std::string& format);

}  // namespace phrenic::daemon

#endif  // PHRENIC_SERVER_DAEMON_LOG_H_
