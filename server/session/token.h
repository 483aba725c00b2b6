// Secrets that name their bearer: 128 random bits in hexadecimal. They go into no log, no address and no error.
#ifndef PHRENIC_SERVER_SESSION_TOKEN_H_
#define PHRENIC_SERVER_SESSION_TOKEN_H_

#include <string>
#include <string_view>

namespace phrenic::session {

// From OpenSSL's generator, which the system seeds. Any thread may call.
std::string NewToken();

// Takes the same time wherever they differ, so that nobody finds a token out by measuring. An empty one equals none.
bool SameToken(std::string_view a, std::string_view b);

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_TOKEN_H_
