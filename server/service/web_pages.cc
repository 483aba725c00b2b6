#include "server/service/web_pages.h"

namespace phrenic::service {
namespace {

constexpr unsigned kGood = 200, kWho = 401, kNotNow = 503;  // of HTTP
constexpr char kPlain[] = "text/plain; charset=utf-8";

}  // namespace

std::optional<WebSettings::Page> WebPages::Find(std::string_view target, std::string_view authorization) {
  if (target == "/healthz") return WebSettings::Page{kGood, kPlain, "ok\n"};
  if (target == "/readyz") {
    return ready_ ? WebSettings::Page{kGood, kPlain, "ready\n"} : WebSettings::Page{kNotNow, kPlain, "not ready\n"};
  }
  if (target != "/metrics") return std::nullopt;
  if (!guard_.IsAdmin(authorization)) {
    return WebSettings::Page{kWho, kPlain, "authorization: the numbers are for the role admin\n"};
  }
  return WebSettings::Page{kGood, "text/plain; version=0.0.4; charset=utf-8", metrics_.Text(table_)};
}

}  // namespace phrenic::service
