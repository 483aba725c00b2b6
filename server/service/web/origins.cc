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

bool IsLoopback(std::string_view host) {
  const std::string_view name = WithoutPort(host);
  return name == "localhost" || name == "127.0.0.1" || name == "[::1]";
}

}  // namespace

bool MayCall(std::string_view origin, std::string_view host, const std::vector<std::string>& allowed) {
  if (origin.empty()) return true;
  if (std::find(allowed.begin(), allowed.end(), origin) != allowed.end()) return true;
  const std::size_t scheme = origin.find("://");
  if (scheme == std::string_view::npos) return false;
  const std::string_view name = origin.substr(0, scheme);
  if (name != "http" && name != "https") return false;
  const std::string_view page = origin.substr(scheme + 3);
  return page == host || IsLoopback(page);
}

}  // namespace phrenic::service
