#include "server/access/jwt.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "server/access/fetch.h"
#include "server/access/rules.h"
#include "server/schema/file_bytes.h"

namespace phrenic::access {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxNameBytes = 255;       // as of "sub" in OpenID Connect Core 1.0 section 2
constexpr double kLastSecond = 253'402'300'799;  // of the year 9999
constexpr absl::Duration kClockSkew = absl::Seconds(60);

absl::Status Refused(const std::string& why) {
  return absl::UnauthenticatedError(absl::StrCat("authorization: the token ", why, "; sign in again"));
}

std::string TextOf(const json& claims, const std::string& name) {
  const auto found = claims.find(name);
  return found != claims.end() && found->is_string() ? found->get<std::string>() : "";
}

bool HasText(const json& claims, const std::string& name, const std::string& wanted) {
  const auto found = claims.find(name);
  if (found == claims.end()) return false;
  if (found->is_array()) return std::find(found->begin(), found->end(), json(wanted)) != found->end();
  return found->is_string() && found->get<std::string>() == wanted;
}

// Returns a NumericDate claim (RFC 7519 section 2); nullopt if it is missing. UNAUTHENTICATED if it is no time.
absl::StatusOr<std::optional<absl::Time>> TimeOf(const json& claims, const char* name) {
  const auto found = claims.find(name);
  if (found == claims.end()) return std::nullopt;
  const double seconds = found->is_number() ? found->get<double>() : -1;
  if (seconds >= 0 && seconds <= kLastSecond) return absl::UnixEpoch() + absl::Seconds(seconds);
  return Refused(absl::StrCat("has a time (", name, ") that is not a number of seconds from 1970 to 9999"));
}

absl::Status CheckTimes(const json& claims, absl::Time now) {
  const auto expires = TimeOf(claims, "exp"), begins = TimeOf(claims, "nbf"), issued = TimeOf(claims, "iat");
  for (const auto* time : {&expires, &begins, &issued}) {
    if (!time->ok()) return time->status();
  }
  if (!expires->has_value() || **expires + kClockSkew <= now) return Refused("has no expiry time (exp) or has expired");
  if (begins->has_value() && **begins - kClockSkew > now) return Refused("is not valid yet (nbf)");
  return absl::OkStatus();
}

// True for a character of two or three bytes that is not printed, breaks a line or changes the direction of the text:
// C1 controls, U+200B to U+200F, U+2028 to U+202E, U+2060 to U+206F and U+FEFF.
bool IsHidden(std::string_view rest) {
  const auto byte = [rest](std::size_t i) { return i < rest.size() ? static_cast<unsigned char>(rest[i]) : 0U; };
  if (byte(0) == 0xC2) return byte(1) < 0xA0;
  if (byte(0) == 0xEF) return byte(1) == 0xBB && byte(2) == 0xBF;
  if (byte(0) != 0xE2) return false;
  if (byte(1) == 0x80) return (byte(2) >= 0x8B && byte(2) <= 0x8F) || (byte(2) >= 0xA8 && byte(2) <= 0xAE);
  return byte(1) == 0x81 && byte(2) >= 0xA0 && byte(2) <= 0xAF;
}

// True if a name can be shown and logged in one line. Requires: UTF-8, which JSON's parser has checked.
bool IsPrintable(std::string_view name) {
  for (std::size_t i = 0; i < name.size(); ++i) {
    if (absl::ascii_iscntrl(static_cast<unsigned char>(name[i])) || IsHidden(name.substr(i))) return false;
  }
  return !name.empty() && name.front() != ' ' && name.back() != ' ';
}

// Returns the highest role that the claim names.
v1::AccessRole RoleIn(const json& claims, const std::string& claim) {
  for (int role = v1::ACCESS_ROLE_ADMIN; role > v1::ACCESS_ROLE_UNSPECIFIED; --role) {
    const auto candidate = static_cast<v1::AccessRole>(role);
    if (HasText(claims, claim, std::string(NameOf(candidate)))) return candidate;
  }
  return v1::ACCESS_ROLE_UNSPECIFIED;
}

absl::StatusOr<std::string> ReadText(const std::string& source) {
  if (IsAddress(source)) return Fetch(source);
  return ReadBytes(source).value_or("");
}

absl::StatusOr<json> ReadKeySet(std::string source) {
  for (int documents = 0; documents < 2; ++documents) {
    const auto text = ReadText(source);
    if (!text.ok()) return absl::Status(text.status().code(), absl::StrCat("--jwt-keys: ", text.status().message()));
    json set = json::parse(*text, nullptr, false);
    if (set.is_object() && set.contains("keys") && set["keys"].is_array()) return set;
    if (!set.is_object() || !set.contains("jwks_uri") || !set["jwks_uri"].is_string()) break;
    source = set["jwks_uri"].get<std::string>();
    if (!IsAddress(source)) break;
  }
  return absl::InvalidArgumentError(absl::StrCat(
      "--jwt-keys: ", source, " is not a JSON Web Key Set, {\"keys\": [...]}, and has no jwks_uri that names one"));
}

}  // namespace

absl::StatusOr<std::shared_ptr<const JwtKeys>> JwtKeys::Read(const JwtOptions& options) {
  if (options.issuer.empty() || options.audience.empty()) {
    return absl::InvalidArgumentError("--jwt-issuer, --jwt-audience: required with --jwt-keys");
  }
  const absl::StatusOr<json> set = ReadKeySet(options.keys);
  if (!set.ok()) return set.status();
  auto keys = KeySet::Parse(set->dump());
  if (keys != nullptr) return std::shared_ptr<const JwtKeys>(new JwtKeys(options, std::move(keys)));
  return absl::InvalidArgumentError(absl::StrCat("--jwt-keys: ", options.keys, " has no RSA or EC key"));
}

absl::StatusOr<Account> JwtKeys::Check(std::string_view token, absl::Time now) const {
  const auto text = keys_->Verified(token);
  if (!text.ok()) return Refused(std::string(text.status().message()));
  return ReadJwtClaims(*text, options_, now);
}

std::string JwtAccountName(std::string_view issuer, std::string_view subject) {
  return absl::StrCat("jwt:", std::string(issuer), "#", std::string(subject));
}

absl::StatusOr<Account> ReadJwtClaims(std::string_view text, const JwtOptions& options, absl::Time now) {
  const json claims = json::parse(text, nullptr, false);
  if (!claims.is_object()) return Refused("has no claims");
  if (TextOf(claims, "iss") != options.issuer) return Refused("comes from another issuer");
  if (!HasText(claims, "aud", options.audience)) return Refused("is for another audience");
  if (absl::Status status = CheckTimes(claims, now); !status.ok()) return status;
  const std::string subject = TextOf(claims, options.name_claim);
  if (subject.empty()) return Refused(absl::StrCat("has no name in \"", options.name_claim, "\""));
  if (subject.size() > kMaxNameBytes || !IsPrintable(subject)) {
    return Refused(absl::StrCat("has a name in \"", options.name_claim, "\" that is longer than ", kMaxNameBytes,
                                " bytes or cannot be printed in one line"));
  }
  const Account account{JwtAccountName(options.issuer, subject), RoleIn(claims, options.role_claim)};
  if (account.role == v1::ACCESS_ROLE_UNSPECIFIED) {
    return Refused(absl::StrCat("has no role in \"", options.role_claim, "\": viewer, controller, owner, admin"));
  }
  return account;
}

}  // namespace phrenic::access
