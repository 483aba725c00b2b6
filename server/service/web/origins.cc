#include "server/service/web/origins.h"

#include <algorithm>

namespace phrenic::service {
namespace {

// "127.0.0.1:8080" -> "127.0.0.1", "[::1]:8080" -> "[::1]".
std::string_view WithoutPort(std::string_view host) {
  const std::size_t colon = host.find_last_of(':');
  const std::size_t bracket = host.find_last_of(']');
  if (colon == std::string_view::npos || (bracket != std::string_view::npos && bracket > colon)) return host;
  return host.substr(0, colon);
}

bool IsLoopbackHost(std::string_view host) {
  const std::string_view name = WithoutPort(host);
  return name == "localhost" || name == "127.0.0.1" || name == "[::1]";
}

}  // namespace

bool IsAllowedOrigin(std::string_view origin, std::string_view host, const std::vector<std::string>& allowed) {
  if (origin.empty()) return true;
  if (std::find(allowed.begin(), allowed.end(), origin) != allowed.end()) return true;
  const std::size_t scheme_end = origin.find("://");
  if (scheme_end == std::string_view::npos) return false;
  const std::string_view scheme_name = origin.substr(0, scheme_end);
  if (scheme_name != "http" && scheme_name != "https") return false;
  const std::string_view origin_host = origin.substr(scheme_end + 3);
  return origin_host == host || IsLoopbackHost(origin_host);
}

}  // namespace phrenic::service
