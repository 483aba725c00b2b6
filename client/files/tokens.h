// The control tokens of this user's sessions, kept between commands in $XDG_STATE_HOME/phrenic/control, or
// ~/.local/state/phrenic/control. Only the user may read the file. Safe for several processes at a time.
#ifndef PHRENIC_CLIENT_FILES_TOKENS_H_
#define PHRENIC_CLIENT_FILES_TOKENS_H_

#include <string>

#include "client/connection/context.h"

namespace phrenic::client {

// Returns the token of a session on the context's server; empty if there is none.
std::string TokenOf(const Context& context, const std::string& session_id);
// Stores a token. The file keeps the last 1000. If it cannot be written, prints a warning on standard error.
void KeepToken(const Context& context, const std::string& session_id, const std::string& token);
// Removes the session's token, if there is one.
void ForgetToken(const Context& context, const std::string& session_id);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_FILES_TOKENS_H_
