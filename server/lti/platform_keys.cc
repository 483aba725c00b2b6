#include "server/lti/platform_keys.h"

#include "absl/strings/str_cat.h"

namespace phrenic::lti {
namespace {

constexpr absl::Duration kKeptKeys = absl::Hours(1), kBetweenFetches = absl::Seconds(10), kOldestKeys = absl::Hours(24);

}  // namespace

absl::StatusOr<std::shared_ptr<const access::KeySet>> PlatformKeys::Keys(absl::Duration age, absl::Time now) {
  absl::MutexLock lock(&mutex_);
  if (keys_ != nullptr && now - fetched_ < age) return keys_;
  absl::Status outcome =
      absl::UnavailableError(absl::StrCat(url_, ": cannot be read; it is tried again in some seconds"));
  if (now - tried_ >= kBetweenFetches) {
    tried_ = now;
    outcome = Renew(now);
  }
  if (outcome.ok() || (keys_ != nullptr && now - fetched_ < kOldestKeys)) return keys_;
  keys_ = nullptr;
  return outcome;
}

absl::Status PlatformKeys::Renew(absl::Time now) {
  const auto text = fetch_(url_);
  if (!text.ok()) return text.status();
  auto keys = access::KeySet::Parse(*text);
  if (keys == nullptr) {
    return absl::UnavailableError(absl::StrCat(url_, ": is not a JSON Web Key Set with an RSA or EC key"));
  }
  keys_ = std::move(keys);
  fetched_ = now;
  return absl::OkStatus();
}

absl::StatusOr<std::string> PlatformKeys::Verified(std::string_view token, absl::Time now) {
  const auto kept = Keys(kKeptKeys, now);
  if (!kept.ok()) return kept.status();
  auto claims = (*kept)->Verified(token);
  if (claims.ok()) return claims;
  const auto renewed = Keys(kBetweenFetches, now);
  if (!renewed.ok() || *renewed == *kept) return claims;
  return (*renewed)->Verified(token);
}

}  // namespace phrenic::lti
