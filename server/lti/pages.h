// The pages that a learning platform's users see on their way to a lesson, with their Content Security Policies.
#ifndef PHRENIC_SERVER_LTI_PAGES_H_
#define PHRENIC_SERVER_LTI_PAGES_H_

#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "phrenic/v1/lesson.pb.h"
#include "server/lti/http.h"
#include "server/lti/platform.h"

namespace phrenic::lti {

// All functions are pure and thread-safe. Pages contain no script; the style and the script of SendPage are files of
// this server (AssetOf). `framers` are the origins whose pages may frame the page.

// Says in plain words why a launch was refused. `status` maps to 400, 401, 403, 404 or 503.
Response ErrorPage(const absl::Status& status, const std::vector<std::string>& framers);

// Asks a teacher for a lesson; the form goes to /lti/select with the ticket.
Response ChoicePage(const std::vector<std::pair<std::string, v1::Lesson>>& lessons, const std::string& ticket,
                    const std::vector<std::string>& framers);

// Posts a token as the field JWT to the platform, by itself or by a button where scripts do not run.
Response SendPage(const std::string& address, const std::string& token, const std::vector<std::string>& framers);

// Redirects the browser, with 303.
Response Redirect(const std::string& address);

// Returns "/lti/style.css" or "/lti/send.js"; 404 for other paths.
Response AssetOf(std::string_view path);

// Returns the origins of a platform as the pages that may frame this server's.
std::vector<std::string> FramersOf(const Platform& platform);

}  // namespace phrenic::lti

#endif  // PHRENIC_SERVER_LTI_PAGES_H_
