// The page tokens of ListSessions: opaque, so that they tell nothing and cannot be made up.
#ifndef PHRENIC_SERVER_SERVICE_CALLS_PAGE_TOKENS_H_
#define PHRENIC_SERVER_SERVICE_CALLS_PAGE_TOKENS_H_

#include <string>
#include <string_view>

#include "absl/status/statusor.h"

namespace phrenic::service {

// A token is the id of the last session listed, which the caller has seen, sealed by AES-256-GCM. Immutable and
// thread-safe.
class PageTokens {
 public:
  // Makes a random key: tokens are valid for this process, and for the caller to whom they were given.
  PageTokens();
  // Derives the key from a text that the servers of a cluster share: any of them opens a token, for any caller, since
  // the one that merges their lists does not know callers. A forged token gives no more than another page of the
  // sessions that its caller may see.
  explicit PageTokens(std::string_view shared);

  // `caller` is access::Caller::id().
  std::string Seal(std::string_view id, std::string_view caller) const;
  // Returns "" for an empty token, the first page. INVALID_ARGUMENT "page_token: ..." for a token that this server did
  // not give to this caller.
  absl::StatusOr<std::string> Open(std::string_view token, std::string_view caller) const;

 private:
  const std::string key_;
  const bool for_anyone_;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_CALLS_PAGE_TOKENS_H_
