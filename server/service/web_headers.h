// Headers of the gateway's answers.
#ifndef PHRENIC_SERVER_SERVICE_WEB_HEADERS_H_
#define PHRENIC_SERVER_SERVICE_WEB_HEADERS_H_

#include <utility>
// Boost 1.74's Beast needs <utility> before it with C++20.
#include <boost/beast/http.hpp>
#include <map>
#include <string>
#include <string_view>

#include "server/service/static_files.h"

namespace phrenic::service {

using HttpHeader = boost::beast::http::header<false, boost::beast::http::fields>;

// Of every answer: nothing is guessed from bytes.
void SetCommonHeaders(HttpHeader& response);
// Of a file: type, caching, and what the page may load.
void SetFileHeaders(const StaticFile& file, HttpHeader& response);
// Lets a page of `origin` read the answer; does nothing where it is empty.
void AllowOrigin(const std::string& origin, HttpHeader& response);
// The head of the answer to a gRPC-web call, up to the empty line.
std::string CallHead(bool text, const std::string& origin, bool keep_alive);
// The headers of a request that are the caller's own: "x-session-id" and the like, and "authorization".
std::multimap<std::string, std::string> CallMetadata(const boost::beast::http::fields& request);

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_WEB_HEADERS_H_
