#include "server/service/watch/watch_claims.h"

#include "server/crypto/secret.h"

namespace phrenic::service {

std::unique_ptr<WatchClaims::Claim> WatchClaims::Add(Taker taker) {
  std::string key = NewToken();
  absl::MutexLock lock(&mutex_);
  takers_.emplace(key, std::move(taker));
  return std::make_unique<Claim>(*this, std::move(key));
}

bool WatchClaims::Has(const std::string& key) const {
  absl::MutexLock lock(&mutex_);
  return takers_.contains(key);
}

bool WatchClaims::Give(const std::string& key, std::shared_ptr<ClaimedWatch> watch) {
  absl::MutexLock lock(&mutex_);
  const auto found = takers_.find(key);
  if (found == takers_.end()) return false;
  found->second(std::move(watch));
  takers_.erase(found);
  return true;
}

void WatchClaims::Remove(const std::string& key) {
  absl::MutexLock lock(&mutex_);
  takers_.erase(key);
}

}  // namespace phrenic::service
