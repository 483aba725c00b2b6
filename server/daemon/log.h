// The log on standard error.
#ifndef PHRENIC_SERVER_DAEMON_LOG_H_
#define PHRENIC_SERVER_DAEMON_LOG_H_

#include <string>

namespace phrenic::daemon {

// "text" for people, "json" an object a line: time, level, message. It names no session, no caller and no scene of
// anybody's own: what people call them may say who the patient is.
void StartLog(const std::string& form);

}  // namespace phrenic::daemon

#endif  // PHRENIC_SERVER_DAEMON_LOG_H_
