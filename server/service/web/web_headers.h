// Headers of the gateway's answers.
#ifndef PHRENIC_SERVER_SERVICE_WEB_WEB_HEADERS_H_
#define PHRENIC_SERVER_SERVICE_WEB_WEB_HEADERS_H_

#include <utility>
// Boost 1.74's Beast needs <utility> before it with C++20.
#include <boost/beast/http.hpp>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "server/service/web/static_files.h"

namespace phrenic::service {

using HttpHeader = boost::beast::http::header<false, boost::beast::http::fields>;

// Of every answer: nothing is guessed from bytes, no other page may use it; and where it is encrypted, browsers come
// back encrypted for a year (RFC 6797).
void SetCommonHeaders(bool encrypted, HttpHeader& response);
// Of a file: type, caching, what the page may load, and which origins' pages may show it in a frame.
void SetFileHeaders(const StaticFile& file, const std::vector<std::string>& framers, HttpHeader& response);
// Lets a page of `origin` read the answer; does nothing where it is empty.
void AllowOrigin(const std::string& origin, HttpHeader& response);
// The head of the answer to a gRPC-web call, up to the empty line.
std::string CallHead(bool text, bool encrypted, const std::string& origin, bool keep_alive);
// Where the gateway names the machine that a call comes from; nobody else can.
inline constexpr char kPeerHeader[] = "x-phrenic-peer";
// The headers of a request that are the caller's own: "x-session-id" and the like, and "authorization"; and its peer.
std::multimap<std::string, std::string> CallMetadata(const boost::beast::http::fields& request,
                                                     const std::string& peer);

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_WEB_WEB_HEADERS_H_
