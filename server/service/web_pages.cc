#include "server/service/web_pages.h"

namespace phrenic::service {
namespace {

constexpr unsigned kOk = 200, kUnauthorized = 401, kUnavailable = 503;  // RFC 9110 section 15
constexpr char kPlain[] = "text/plain; charset=utf-8";

}  // namespace

std::optional<WebSettings::Page> WebPages::Find(std::string_view target, std::string_view authorization) {
  if (target == "/healthz") return WebSettings::Page{kOk, kPlain, "ok\n"};
  if (target == "/readyz") {
    return ready_ ? WebSettings::Page{kOk, kPlain, "ready\n"} : WebSettings::Page{kUnavailable, kPlain, "not ready\n"};
  }
  if (target != "/metrics") return std::nullopt;
  if (!guard_.IsAdmin(authorization)) {
    return WebSettings::Page{kUnauthorized, kPlain, "authorization: the metrics require the role admin\n"};
  }
  return WebSettings::Page{kOk, "text/plain; version=0.0.4; charset=utf-8", metrics_.Text(table_)};
}

}  // namespace phrenic::service
