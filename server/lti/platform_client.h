// Calls a learning platform's services: scores (Assignment and Grade Services 2.0) and names of members (Names and Role
// Provisioning Services 2.0).
#ifndef PHRENIC_SERVER_LTI_PLATFORM_CLIENT_H_
#define PHRENIC_SERVER_LTI_PLATFORM_CLIENT_H_

#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "absl/base/thread_annotations.h"
#include "absl/status/statusor.h"
#include "absl/synchronization/mutex.h"
#include "absl/time/time.h"
#include "server/access/fetch.h"
#include "server/lti/platform.h"
#include "server/lti/tool_key.h"

namespace phrenic::lti {

// Sends a request; access::Exchange, or that of a test.
using ExchangeHttp = std::function<absl::StatusOr<access::HttpAnswer>(const access::HttpRequest& request)>;

// Names of a course's members by their "sub".
using MemberNames = std::map<std::string, std::string>;

// Thread-safe. Blocks the calling thread. Keeps an access token for each scope until shortly before it expires. All
// addresses are checked by CheckAddress. Errors: UNAVAILABLE if a repeat may succeed, also if no access token is given;
// INVALID_ARGUMENT with the platform's origin and status if it refuses for good.
class PlatformClient {
 public:
  // `platform` and `key` outlive the client.
  PlatformClient(const Platform& platform, const ToolKey& key, ExchangeHttp exchange)
      : platform_(platform), key_(key), exchange_(std::move(exchange)) {}

  // Sends a score to a line item.
  absl::Status SendScore(const std::string& line_item, const nlohmann::json& score);
  // Returns the names at the address "context_memberships_url": 20 pages and 10,000 members at most. Returns
  // those of the pages before one that cannot be read, or that would begin after the deadline.
  absl::StatusOr<MemberNames> Members(const std::string& address, absl::Time deadline = absl::InfiniteFuture());

 private:
  struct Token {
    std::string text;
    absl::Time expires;
  };

  // Returns an access token (RFC 7523 section 2.2: client credentials, a signed assertion).
  absl::StatusOr<std::string> AccessToken(const std::string& scope) ABSL_LOCKS_EXCLUDED(mutex_);
  void ForgetToken(const std::string& scope) ABSL_LOCKS_EXCLUDED(mutex_);
  // Sends a request with a token of the scope; a token that is not accepted is replaced once.
  absl::StatusOr<access::HttpAnswer> Call(access::HttpRequest request, const std::string& scope);

  const Platform& platform_;
  const ToolKey& key_;
  const ExchangeHttp exchange_;
  absl::Mutex mutex_;
  std::map<std::string, Token> tokens_ ABSL_GUARDED_BY(mutex_);  // by scope
};

// Returns OK for a status of success, INVALID_ARGUMENT for 400, 404 and 422, which refuse this very content or address,
// and UNAVAILABLE for all others, where a repeat may succeed: also 401 and 403, since a wrong setting can be corrected.
// `who` is the origin that answered.
absl::Status StatusOfHttp(const std::string& who, long status);

}  // namespace phrenic::lti

#endif  // PHRENIC_SERVER_LTI_PLATFORM_CLIENT_H_
