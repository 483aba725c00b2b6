#include "server/access/issued_tokens.h"

#include <algorithm>

#include "server/crypto/secret.h"
#include "server/crypto/sha256.h"

namespace phrenic::access {
namespace {

constexpr std::size_t kMostIssued = 10'000;

}  // namespace

std::string IssuedTokens::Issue(const Account& account, absl::Time expires) {
  std::string token = NewToken();
  absl::MutexLock lock(&mutex_);
  if (tokens_.size() >= kMostIssued) {
    tokens_.erase(std::min_element(tokens_.begin(), tokens_.end(),
                                   [](const auto& a, const auto& b) { return a.second.expires < b.second.expires; }));
  }
  tokens_[Sha256Hex(token)] = {account, expires};
  return token;
}

std::optional<Account> IssuedTokens::Find(std::string_view sha256, absl::Time now) const {
  absl::MutexLock lock(&mutex_);
  const auto found = tokens_.find(sha256);
  return found == tokens_.end() || found->second.expires <= now ? std::nullopt : std::optional(found->second.account);
}

}  // namespace phrenic::access
