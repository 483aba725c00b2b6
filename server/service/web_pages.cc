#include "server/service/web_pages.h"

namespace phrenic::service {
namespace {

constexpr unsigned kOk = 200, kUnauthorized = 401, kUnavailable = 503;  // RFC 9110 section 15
constexpr char kPlain[] = "text/plain; charset=utf-8";

}  // namespace

std::optional<WebSettings::Page> WebPages::Find(std::string_view target, const WebSettings::Credentials& credentials) {
  if (target == "/healthz") return WebSettings::Page{kOk, kPlain, "ok\n"};
  if (target == "/readyz") {
    return ready_ ? WebSettings::Page{kOk, kPlain, "ready\n"} : WebSettings::Page{kUnavailable, kPlain, "not ready\n"};
  }
  if (target == "/known") {
    const bool known = guard_.Known(credentials.authorization, credentials.join).has_value();
    return WebSettings::Page{known ? kOk : kUnauthorized, kPlain, known ? "known\n" : "not known\n"};
  }
  if (target != "/metrics") return std::nullopt;
  if (!guard_.IsAdmin(credentials.authorization)) {
    return WebSettings::Page{kUnauthorized, kPlain, "authorization: the metrics require the role admin\n"};
  }
  return WebSettings::Page{kOk, "text/plain; version=0.0.4; charset=utf-8", metrics_.Text(table_)};
}

}  // namespace phrenic::service
