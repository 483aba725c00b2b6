// HTTP requests to other servers (libcurl).
#ifndef PHRENIC_SERVER_ACCESS_FETCH_H_
#define PHRENIC_SERVER_ACCESS_FETCH_H_

#include <atomic>
#include <string>
#include <vector>

#include "absl/status/statusor.h"

namespace phrenic::access {

// True if the text begins with "https://" or "http://"; otherwise it is a file.
bool IsAddress(const std::string& text);

// True for an https:// address, and for http:// on loopback, where traffic cannot be read or modified on a network.
bool IsSafeAddress(const std::string& text);

struct HttpRequest {
  std::string address;
  std::vector<std::string> headers = {};  // "Name: value"
  bool post = false;
  std::string body = "";                         // of a POST
  const std::atomic<bool>* cancelled = nullptr;  // ends the request with UNAVAILABLE soon after it is true; null: never
};

struct HttpAnswer {
  long status = 0;
  std::string body;
  std::string link;  // the headers Link (RFC 8288), with ", " between them; 64 KiB at most
};

// Returns the answer to a request, whatever its status. Does not follow redirects; the server's certificate must be
// trusted by the system. Thread-safe. Blocks the calling thread.
// Errors: INVALID_ARGUMENT unless IsSafeAddress; UNAVAILABLE, with the address without its query and the reason, if the
// answer takes longer than 10 s or is larger than 1 MiB.
absl::StatusOr<HttpAnswer> Exchange(const HttpRequest& request);

// Returns the document. Does not follow redirects; the server's certificate must be trusted by the system. Thread-safe.
// Errors: INVALID_ARGUMENT for http:// except on loopback; UNAVAILABLE, with the address and the reason, if the
// document takes longer than 10 s, is larger than 1 MiB, or has a status other than 200. Blocks the calling thread.
absl::StatusOr<std::string> Fetch(const std::string& address);

}  // namespace phrenic::access

#endif  // PHRENIC_SERVER_ACCESS_FETCH_H_
