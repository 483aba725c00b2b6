#include "server/service/web/web_headers.h"

#include <algorithm>
#include <sstream>

#include "absl/strings/ascii.h"
#include "absl/strings/escaping.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "server/service/net/metadata_keys.h"

namespace phrenic::service {
namespace {

namespace http = boost::beast::http;

// The policy in the page itself (web/vite.config.ts) and, appended, the origins that may frame it.
constexpr char kPolicy[] =
    "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self'; img-src 'self' data: blob:; "
    "connect-src 'self'; "
    "base-uri 'none'; form-action 'none'; frame-ancestors ";

bool IsForwarded(const std::string& name) {
  if (name == "x-grpc-web" || name == "x-user-agent" || name == kPeerKey) return false;
  return absl::StartsWith(name, "x-") || name == "authorization";
}

// Adds the values of a "-bin" header, separated by commas. False if one is not base64.
bool AddBinary(const std::string& name, absl::string_view values, Metadata& metadata) {
  for (const absl::string_view value : absl::StrSplit(values, ',')) {
    std::string bytes;
    if (!absl::Base64Unescape(absl::StripAsciiWhitespace(value), &bytes)) return false;
    metadata.emplace(name, std::move(bytes));
  }
  return true;
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
  if (!file.encoding.empty()) response.set(http::field::content_encoding, file.encoding);
  if (file.varies) response.set(http::field::vary, "Accept-Encoding");
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

absl::StatusOr<Metadata> CallMetadata(const http::fields& request, const std::string& peer) {
  Metadata metadata = {{kPeerKey, peer}};
  for (const auto& field : request) {
    const std::string name = absl::AsciiStrToLower(std::string(field.name_string()));
    if (!IsForwarded(name)) continue;
    const absl::string_view value(field.value().data(), field.value().size());
    if (!absl::EndsWith(name, "-bin")) {
      metadata.emplace(name, std::string(value));
    } else if (!AddBinary(name, value, metadata)) {
      return absl::InvalidArgumentError(absl::StrCat(absl::CHexEscape(name), ": its value is not base64"));
    }
  }
  absl::Status status = CheckMetadata(metadata);
  return status.ok() ? absl::StatusOr<Metadata>(std::move(metadata)) : status;
}

bool AllowPreflight(const std::string& origin, std::string_view headers, HttpHeader& response) {
  const auto legal = [](char c) {
    return absl::ascii_isalnum(c) || absl::StrContains("-_., ", absl::string_view(&c, 1));
  };
  if (!std::all_of(headers.begin(), headers.end(), legal)) return false;
  AllowOrigin(origin, response);
  response.set(http::field::access_control_allow_methods, "POST, GET, HEAD, OPTIONS");
  response.set(http::field::access_control_allow_headers, boost::beast::string_view(headers.data(), headers.size()));
  response.set(http::field::access_control_max_age, "7200");
  return true;
}

}  // namespace phrenic::service
