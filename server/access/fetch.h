// Fetches a public document, such as a key set, by HTTP (libcurl).
#ifndef PHRENIC_SERVER_ACCESS_FETCH_H_
#define PHRENIC_SERVER_ACCESS_FETCH_H_

#include <string>

#include "absl/status/statusor.h"

namespace phrenic::access {

// True if the text begins with "https://" or "http://"; otherwise it is a file.
bool IsAddress(const std::string& text);

// Returns the document. Does not follow redirects; the server's certificate must be trusted by the system. Thread-safe.
// Errors: INVALID_ARGUMENT for http:// except on loopback; UNAVAILABLE, with the address and the reason, if the
// document takes longer than 10 s, is larger than 1 MiB, or has a status other than 200. Blocks the calling thread.
absl::StatusOr<std::string> Fetch(const std::string& address);

}  // namespace phrenic::access

#endif  // PHRENIC_SERVER_ACCESS_FETCH_H_
