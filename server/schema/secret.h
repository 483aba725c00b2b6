// Secrets that name their bearer: 128 random bits in hexadecimal. They go into no log, no address and no error.
#ifndef PHRENIC_SERVER_SCHEMA_SECRET_H_
#define PHRENIC_SERVER_SCHEMA_SECRET_H_

#include <string>
#include <string_view>

namespace phrenic {

// From OpenSSL's generator, which the system seeds. Any thread may call.
std::string NewToken();

// Takes the same time wherever they differ, so that nobody finds a token out by measuring. An empty one equals none.
bool SameToken(std::string_view a, std::string_view b);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_SCHEMA_SECRET_H_
