#include "server/service/web/web_request.h"

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "server/service/web/grpc_web.h"
#include "server/service/web/web_headers.h"

namespace phrenic::service {
namespace {

namespace http = boost::beast::http;

absl::string_view TextIn(const HttpRequestHead& head, http::field name) {
  const auto value = head[name];
  return {value.data(), value.size()};
}

Refusal BadRequest(std::string text) { return {http::status::bad_request, std::move(text)}; }

std::optional<Refusal> CheckRepeated(const HttpRequestHead& head) {
  for (const http::field name :
       {http::field::host, http::field::origin, http::field::content_length, http::field::transfer_encoding,
        http::field::content_type, http::field::authorization}) {
    if (head.count(name) <= 1) continue;
    const auto text = http::to_string(name);
    return BadRequest(absl::StrCat(std::string(text.data(), text.size()), ": given more than once; send it once"));
  }
  return std::nullopt;
}

}  // namespace

std::optional<Refusal> CheckFraming(const HttpRequestHead& head) {
  if (!absl::StartsWith({head.target().data(), head.target().size()}, "/")) {
    return BadRequest("the address does not begin with /");
  }
  if (auto refusal = CheckRepeated(head)) return refusal;
  const absl::string_view encoding = TextIn(head, http::field::transfer_encoding);
  const absl::string_view length = TextIn(head, http::field::content_length);
  if (head.count(http::field::transfer_encoding) > 0) {
    if (!absl::EqualsIgnoreCase(encoding, "chunked")) return BadRequest("Transfer-Encoding: must be \"chunked\"");
    if (head.count(http::field::content_length) > 0) {
      return BadRequest("Content-Length: not allowed together with Transfer-Encoding");
    }
    if (head.version() < 11) return BadRequest("Transfer-Encoding: needs HTTP/1.1");
  }
  if (absl::StrContains(length, ",")) return BadRequest("Content-Length: given more than once; send it once");
  return std::nullopt;
}

std::optional<Refusal> CheckHost(const HttpRequestHead& head, const AllowedHosts& hosts,
                                 const boost::asio::ip::address& local, X509* certificate) {
  const absl::string_view host = TextIn(head, http::field::host);
  if (host.empty()) return BadRequest("Host: missing; send the name of this server");
  if (hosts.Allow({host.data(), host.size()}, local, certificate)) return std::nullopt;
  return Refusal{http::status::misdirected_request,
                 "Host: this server does not answer to that name; start it with --allow-host NAME"};
}

std::optional<Refusal> CheckMethodAndType(const HttpRequestHead& head) {
  const http::verb method = head.method();
  if (method == http::verb::get || method == http::verb::head || method == http::verb::options) return std::nullopt;
  if (method != http::verb::post) {
    return Refusal{http::status::method_not_allowed, "the method must be GET, HEAD or POST"};
  }
  const absl::string_view type = TextIn(head, http::field::content_type);
  if (!IsGrpcWeb({type.data(), type.size()})) {
    return Refusal{http::status::unsupported_media_type,
                   "a POST must be a gRPC-web call: Content-Type application/grpc-web+proto"};
  }
  if (head.version() >= 11) return std::nullopt;
  return Refusal{http::status::http_version_not_supported, "gRPC-web needs HTTP/1.1"};
}

absl::StatusOr<WebCall::Request> CallOf(const HttpRequestHead& head, const std::string& peer) {
  auto metadata = CallMetadata(head, peer);
  if (!metadata.ok()) return metadata.status();
  const auto timeout = head["grpc-timeout"];
  return WebCall::Request{.method = std::string(head.target().data(), head.target().size()),
                          .message = {},
                          .metadata = *std::move(metadata),
                          .timeout = ParseTimeout({timeout.data(), timeout.size()})};
}

}  // namespace phrenic::service
