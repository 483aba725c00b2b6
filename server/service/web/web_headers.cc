#include "server/service/web/web_headers.h"

#include <sstream>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "server/service/net/metadata_keys.h"

namespace phrenic::service {
namespace {

namespace http = boost::beast::http;

// The policy in the page itself (web/vite.config.ts) and, appended, the origins that may frame it.
constexpr char kPolicy[] =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; connect-src 'self'; "
    "base-uri 'none'; form-action 'none'; frame-ancestors ";

bool IsForwarded(const std::string& name) {
  if (name == "x-grpc-web" || name == "x-user-agent" || name == kPeerKey) return false;
  return absl::StartsWith(name, "x-") || name == "authorization";
}

}  // namespace

void SetCommonHeaders(bool encrypted, HttpHeader& response) {
  response.set(http::field::server, "phrenicd");
  response.set("X-Content-Type-Options", "nosniff");
  response.set("Cross-Origin-Resource-Policy", "same-origin");
  if (encrypted) response.set("Strict-Transport-Security", "max-age=31536000");
}

void SetFileHeaders(const StaticFile& file, const std::vector<std::string>& framers, HttpHeader& response) {
  response.set(http::field::content_type, file.content_type);
  response.set(http::field::etag, file.etag);
  response.set(http::field::cache_control, file.cache_control);
  response.set("Content-Security-Policy",
               absl::StrCat(kPolicy, framers.empty() ? "'none'" : absl::StrJoin(framers, " ")));
  response.set("Referrer-Policy", "no-referrer");
  response.set("Cross-Origin-Opener-Policy", "same-origin");
  response.set("Permissions-Policy", "camera=(), microphone=(), geolocation=(), payment=(), usb=()");
  if (framers.empty()) response.set("X-Frame-Options", "DENY");  // for browsers without frame-ancestors
}

void AllowOrigin(const std::string& origin, HttpHeader& response) {
  if (origin.empty()) return;
  response.set(http::field::access_control_allow_origin, origin);
  response.set(http::field::vary, "Origin");
  response.set(http::field::access_control_expose_headers, "grpc-status, grpc-message");
}

std::string CallHead(bool text, bool encrypted, const std::string& origin, bool keep_alive) {
  http::response<http::empty_body> response(http::status::ok, 11);
  SetCommonHeaders(encrypted, response);
  AllowOrigin(origin, response);
  response.set(http::field::content_type, text ? "application/grpc-web-text+proto" : "application/grpc-web+proto");
  response.set(http::field::cache_control, "no-store");
  response.set(http::field::transfer_encoding, "chunked");
  response.keep_alive(keep_alive);
  std::ostringstream head;
  head << response.base();
  return head.str();
}

std::multimap<std::string, std::string> CallMetadata(const http::fields& request, const std::string& peer) {
  std::multimap<std::string, std::string> metadata = {{kPeerKey, peer}};
  for (const auto& field : request) {
    const std::string name = absl::AsciiStrToLower(std::string(field.name_string()));
    if (IsForwarded(name)) metadata.emplace(name, std::string(field.value()));
  }
  return metadata;
}

}  // namespace phrenic::service
