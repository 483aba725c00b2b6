// The page tokens of ListSessions: opaque, so that they tell nothing and cannot be made up.
#ifndef PHRENIC_SERVER_SERVICE_CALLS_PAGE_TOKENS_H_
#define PHRENIC_SERVER_SERVICE_CALLS_PAGE_TOKENS_H_

#include <string>
#include <string_view>

#include "absl/status/statusor.h"

namespace phrenic::service {

// A token is the id of the last session listed, which the caller has seen, sealed by AES-256-GCM. Immutable and
// thread-safe.
//
// The text of a token is nonce, tag and sealed id in base64 for URLs. SessionService seals and opens tokens; in a
// cluster the server that merges the lists seals the token of the merged page.
class PageTokens {
 public:
  // Makes a random key: tokens are valid for this process, and for the caller to whom they were given. The process ends
  // (abort) if the system has no randomness, here and in Seal.
  PageTokens();
  // Derives the key from a text that the servers of a cluster share: any of them opens a token, for any caller, since
  // the one that merges their lists does not know callers. A forged token gives no more than another page of the
  // sessions that its caller may see.
  explicit PageTokens(std::string_view shared);

  // `caller` is access::Caller::id(). Each call returns another token for the same id. Requires: `id` is not empty,
  // since Open refuses such a token.
  std::string Seal(std::string_view id, std::string_view caller) const;
  // Returns "" for an empty token, the first page. INVALID_ARGUMENT "page_token: ..." for a token that this server did
  // not give to this caller. Refuses tokens above 256 bytes before it decodes them. The session of the id may be gone:
  // the list then continues after the place where it was.
  absl::StatusOr<std::string> Open(std::string_view token, std::string_view caller) const;

 private:
  const std::string key_;  // 32 bytes
  const bool for_anyone_;  // the caller is not part of the seal
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_CALLS_PAGE_TOKENS_H_
