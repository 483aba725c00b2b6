// Judges a request by its head, before its body is read.
#ifndef PHRENIC_SERVER_SERVICE_WEB_WEB_REQUEST_H_
#define PHRENIC_SERVER_SERVICE_WEB_WEB_REQUEST_H_

#include <utility>
// Boost 1.74's Beast needs <utility> before it with C++20.
#include <boost/beast/http.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"
#include "server/service/web/hosts.h"
#include "server/service/web/web_call.h"

namespace phrenic::service {

using HttpRequestHead = boost::beast::http::header<true, boost::beast::http::fields>;

// The answer to a request that is not served. Plain text for people, with the remedy. The connection is closed after
// it, since the body is not read.
struct Refusal {
  boost::beast::http::status status;
  std::string text;
};

// Checks the address and the framing, on which every program between client and server must agree (RFC 9112 sections
// 3.2 and 6): 400 unless the target is a path, each of the headers that decide something is given at most once, and the
// body's length is told by either one Content-Length or "Transfer-Encoding: chunked". Pure function, thread-safe.
// Returns nullopt, as the other checks do, if there is nothing to refuse. WebConnection::Judge calls them in the order
// of this header, and checks the origin after the host.
std::optional<Refusal> CheckFraming(const HttpRequestHead& head);

// 400 without a Host, 421 for one that is not allowed. `local` is the address that the client connected to and
// `certificate` the server's, null without TLS. Thread-safe. It keeps a page of another site from reaching the server
// by DNS rebinding (hosts.h).
std::optional<Refusal> CheckHost(const HttpRequestHead& head, const AllowedHosts& hosts,
                                 const boost::asio::ip::address& local, X509* certificate);

// Checks that a POST is a gRPC-web call: 405, 415 or 505 if it is not. Accepts GET, HEAD and OPTIONS. Pure function,
// thread-safe. 405 for another method, 415 for another Content-Type, 505 for HTTP/1.0, which has no chunks.
std::optional<Refusal> CheckMethodAndType(const HttpRequestHead& head);

// Returns the call that a gRPC-web request makes, without its message; `peer` is the caller's IP address. An invalid
// grpc-timeout counts as none. The method's path is checked later, by WebCall::Start. Requires: CheckMethodAndType
// accepts the head.
// Errors: those of CheckMetadata, with the header's name, and INVALID_ARGUMENT if a "-bin" header is not base64.
absl::StatusOr<WebCall::Request> CallOf(const HttpRequestHead& head, const std::string& peer);

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_WEB_WEB_REQUEST_H_
