// HTTP headers of the gateway's responses, and gRPC metadata from request headers. Pure functions, thread-safe.
#ifndef PHRENIC_SERVER_SERVICE_WEB_WEB_HEADERS_H_
#define PHRENIC_SERVER_SERVICE_WEB_WEB_HEADERS_H_

#include <utility>
// Boost 1.74's Beast needs <utility> before it with C++20.
#include <boost/beast/http.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "server/service/net/metadata.h"
#include "server/service/web/static_files.h"

namespace phrenic::service {

using HttpHeader = boost::beast::http::header<false, boost::beast::http::fields>;

// Sets the headers of every response: no MIME sniffing, same-origin resource policy and, with TLS, HSTS for one year
// (RFC 6797). `encrypted` is of the connection.
void SetCommonHeaders(bool encrypted, HttpHeader& response);
// Sets the headers of a file: type, caching, Content Security Policy, and the origins that may frame it. `framers` are
// the allowed origins; without any, no page may frame the viewer. The policy admits scripts, styles and connections of
// the server alone.
void SetFileHeaders(const StaticFile& file, const std::vector<std::string>& framers, HttpHeader& response);
// Sets the CORS headers that let a page of `origin` read the response; does nothing if `origin` is empty. Requires:
// IsAllowedOrigin has accepted the origin.
void AllowOrigin(const std::string& origin, HttpHeader& response);
// Returns the status line and headers of a gRPC-web response, with the empty line that ends them. The HTTP status is
// 200 for every status of the call, and the body is chunked, since its length is unknown. `text` means base64.
std::string CallHead(bool text, bool encrypted, const std::string& origin, bool keep_alive);
// Returns the metadata for a gRPC call: "x-..." and "authorization" headers of the request, and the caller's IP address
// as kPeerKey, which replaces one that the client sent. Values of "-bin" headers are decoded from base64. A "-bin"
// header may have several values, separated by commas. Leaves out "x-grpc-web" and "x-user-agent", which are for the
// gateway.
// Errors: those of CheckMetadata, and INVALID_ARGUMENT, with the header's name, if it is not base64.
absl::StatusOr<Metadata> CallMetadata(const boost::beast::http::fields& request, const std::string& peer);

// Sets the headers that answer a CORS preflight request (Fetch standard section 3.3.6) from a page of `origin`, which
// asked for `headers`. False if these are not names of headers. The browser may keep the answer for 7200 s. Requires:
// IsAllowedOrigin has accepted the origin.
bool AllowPreflight(const std::string& origin, std::string_view headers, HttpHeader& response);

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_WEB_WEB_HEADERS_H_
