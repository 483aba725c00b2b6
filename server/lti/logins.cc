#include "server/lti/logins.h"

#include <cstdint>
#include <vector>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "server/crypto/hmac.h"

namespace phrenic::lti {
namespace {

constexpr std::size_t kMostStateBytes = 256;

}  // namespace

// "RANDOM-EXPIRES-PLATFORM-CODE", the code over what is before it.
std::string Logins::Begin(std::size_t platform, absl::Time now) const {
  const std::string signed_part = absl::StrCat(NewToken(), "-", absl::ToUnixSeconds(now + lifetime_), "-", platform);
  return absl::StrCat(signed_part, "-", HmacSha256Hex(key_, "state " + signed_part));
}

std::optional<Logins::Login> Logins::Read(const std::string& state, absl::Time now) const {
  const std::size_t end = state.rfind('-');
  if (state.size() > kMostStateBytes || end == std::string::npos) return std::nullopt;
  const std::string signed_part = state.substr(0, end);
  if (!SameToken(HmacSha256Hex(key_, "state " + signed_part), state.substr(end + 1))) return std::nullopt;
  const std::vector<std::string> parts = absl::StrSplit(signed_part, '-');
  std::int64_t expires = 0;
  Login login{.platform = 0, .nonce = NonceOf(state)};
  if (parts.size() != 3 || !absl::SimpleAtoi(parts[1], &expires) || !absl::SimpleAtoi(parts[2], &login.platform)) {
    return std::nullopt;
  }
  if (absl::FromUnixSeconds(expires) <= now) return std::nullopt;
  return login;
}

absl::Status Logins::Use(const std::string& state, absl::Time now) {
  absl::MutexLock lock(&mutex_);
  if (used_.size() >= kMostUsedLogins) {
    std::erase_if(used_, [now](const auto& entry) { return entry.second <= now; });
  }
  if (used_.size() >= kMostUsedLogins) {
    return absl::UnavailableError("Too many activities were opened in the last minutes: try again in ten minutes.");
  }
  if (!used_.emplace(state, now + lifetime_).second) {
    return absl::UnauthenticatedError("This launch was used already: open the activity again in your course.");
  }
  return absl::OkStatus();
}

std::string Logins::NonceOf(const std::string& state) const { return HmacSha256Hex(key_, "nonce " + state); }

}  // namespace phrenic::lti
