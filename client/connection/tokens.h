// The tokens by which this user controls sessions, kept from one command to the next: in the file control below
// $XDG_STATE_HOME/phrenic, or ~/.local/state/phrenic, which nobody else may read.
#ifndef PHRENIC_CLIENT_CONNECTION_TOKENS_H_
#define PHRENIC_CLIENT_CONNECTION_TOKENS_H_

#include <string>

#include "client/connection/connection.h"

namespace phrenic::client {

// Empty where there is none.
std::string TokenOf(const Context& context, const std::string& session_id);
// The last 1000 are kept. Where the file cannot be written it is said on standard error, and the command goes on.
void KeepToken(const Context& context, const std::string& session_id, const std::string& token);
void ForgetToken(const Context& context, const std::string& session_id);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CONNECTION_TOKENS_H_
