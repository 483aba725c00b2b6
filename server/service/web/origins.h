// Decides which web origins (RFC 6454) may call the server.
#ifndef PHRENIC_SERVER_SERVICE_WEB_ORIGINS_H_
#define PHRENIC_SERVER_SERVICE_WEB_ORIGINS_H_

#include <string>
#include <string_view>
#include <vector>

namespace phrenic::service {

// True if a request with this Origin header may be answered: the server's own origin (`host` is the Host header), a
// loopback origin such as "http://localhost:5173", an origin in `allowed`, or no origin, as programs send none.
// Thread-safe. A page of a loopback origin may call a server on another machine too: it comes from a program of its
// user. The entries of `allowed` are compared as text, with scheme and port. The opaque origin "null" is refused unless
// `allowed` has it. `host` must have been checked (CheckHost), since a page chooses its own name.
bool IsAllowedOrigin(std::string_view origin, std::string_view host, const std::vector<std::string>& allowed);

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_WEB_ORIGINS_H_
