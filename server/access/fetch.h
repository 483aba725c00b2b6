// Reads a public document, a set of keys say, from an address, by libcurl.
#ifndef PHRENIC_SERVER_ACCESS_FETCH_H_
#define PHRENIC_SERVER_ACCESS_FETCH_H_

#include <string>

#include "absl/status/statusor.h"

namespace phrenic::access {

// Whether the text is an address, and no file.
bool IsAddress(const std::string& text);

// The document. Encrypted, by a server whose certificate the system trusts: INVALID_ARGUMENT for http:// but of this
// machine itself. UNAVAILABLE, with the address and why, where it does not come within ten seconds, is larger than a
// megabyte, or somewhere else. Any thread may call.
absl::StatusOr<std::string> Fetch(const std::string& address);

}  // namespace phrenic::access

#endif  // PHRENIC_SERVER_ACCESS_FETCH_H_
