// Requests of browsers to this server's LTI addresses, and their responses. Plain data.
#ifndef PHRENIC_SERVER_LTI_HTTP_H_
#define PHRENIC_SERVER_LTI_HTTP_H_

#include <string>
#include <utility>
#include <vector>

namespace phrenic::lti {

struct Request {
  bool post = false;
  std::string target;     // path and query, "/lti/login?iss=..."
  std::string body = "";  // of a POST: a form
  std::string cookies = "";
};

struct Response {
  unsigned status = 200;
  std::string type = "text/html; charset=utf-8";
  std::string text = "";
  std::vector<std::pair<std::string, std::string>> headers = {};
};

}  // namespace phrenic::lti

#endif  // PHRENIC_SERVER_LTI_HTTP_H_
