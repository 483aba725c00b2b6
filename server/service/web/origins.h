// Which web pages may call.
#ifndef PHRENIC_SERVER_SERVICE_WEB_ORIGINS_H_
#define PHRENIC_SERVER_SERVICE_WEB_ORIGINS_H_

#include <string>
#include <string_view>
#include <vector>

namespace phrenic::service {

// Pages of the server itself ("http://HOST" or "https://HOST", HOST as the request has it), pages served by this
// machine ("http://localhost:5173"), and those in the list. A request without an origin comes from no page.
bool MayCall(std::string_view origin, std::string_view host, const std::vector<std::string>& allowed);

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_WEB_ORIGINS_H_
