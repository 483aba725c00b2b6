#include "server/access/jwt.h"

#include <cjose/cjose.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "server/access/fetch.h"
#include "server/access/rules.h"
#include "server/schema/file_bytes.h"

namespace phrenic::access {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxTokenBytes = 16 << 10;
constexpr absl::Duration kClockSkew = absl::Seconds(60);
constexpr std::string_view kAlgorithms[] = {"RS256", "RS384", "RS512", "PS256", "PS384",
                                            "PS512", "ES256", "ES384", "ES512"};

absl::Status Refused(const std::string& why) {
  return absl::UnauthenticatedError(absl::StrCat("authorization: the token ", why, "; sign in again"));
}

// True for base64url without padding (RFC 7515 section 2) of whole bytes; cjose ends the process at some other texts.
bool IsBase64Url(std::string_view text) {
  const auto allowed = [](unsigned char c) { return absl::ascii_isalnum(c) || c == '-' || c == '_'; };
  return text.size() % 4 != 1 && std::ranges::all_of(text, allowed);
}

// True if the token has three parts in base64url (RFC 7515 section 7.1).
bool IsCompact(std::string_view token) {
  const std::vector<std::string> parts = absl::StrSplit(std::string(token), '.');
  return parts.size() == 3 && std::ranges::all_of(parts, IsBase64Url);
}

std::string TextOf(const json& claims, const std::string& name) {
  const auto found = claims.find(name);
  return found != claims.end() && found->is_string() ? found->get<std::string>() : "";
}

// True if all numbers of a key are in base64url (RFC 7518 section 6).
bool HasReadableNumbers(const json& key) {
  constexpr const char* kNumbers[] = {"x", "y", "d", "n", "e", "p", "q", "dp", "dq", "qi", "k"};
  return std::ranges::all_of(kNumbers, [&](const char* name) {
    return !key.is_object() || !key.contains(name) || IsBase64Url(TextOf(key, name));
  });
}

bool HasText(const json& claims, const std::string& name, const std::string& wanted) {
  const auto found = claims.find(name);
  if (found == claims.end()) return false;
  if (found->is_array()) return std::find(found->begin(), found->end(), json(wanted)) != found->end();
  return found->is_string() && found->get<std::string>() == wanted;
}

// Returns a NumericDate claim (RFC 7519 section 2), `otherwise` if it is missing or not a number.
absl::Time TimeOf(const json& claims, const char* name, absl::Time otherwise) {
  const auto found = claims.find(name);
  if (found == claims.end() || !found->is_number()) return otherwise;
  return absl::UnixEpoch() + absl::Seconds(found->get<double>());
}

absl::Status CheckTimes(const json& claims, absl::Time now) {
  if (TimeOf(claims, "exp", absl::InfinitePast()) + kClockSkew <= now)
    return Refused("has no expiry time (exp) or has expired");
  if (TimeOf(claims, "nbf", absl::InfinitePast()) - kClockSkew > now) return Refused("is not valid yet (nbf)");
  return absl::OkStatus();
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

struct JwtKeys::Key {
  explicit Key(cjose_jwk_t* imported) : jwk(imported) {}
  ~Key() { cjose_jwk_release(jwk); }
  Key(const Key&) = delete;
  Key& operator=(const Key&) = delete;
  cjose_jwk_t* const jwk;
};

JwtKeys::JwtKeys(JwtOptions options) : options_(std::move(options)) {}

JwtKeys::~JwtKeys() = default;

absl::StatusOr<std::shared_ptr<const JwtKeys>> JwtKeys::Read(const JwtOptions& options) {
  if (options.issuer.empty() || options.audience.empty()) {
    return absl::InvalidArgumentError("--jwt-issuer, --jwt-audience: required with --jwt-keys");
  }
  const absl::StatusOr<json> set = ReadKeySet(options.keys);
  if (!set.ok()) return set.status();
  std::shared_ptr<JwtKeys> keys(new JwtKeys(options));
  for (const json& key : (*set)["keys"]) {
    if (!HasReadableNumbers(key)) continue;
    const std::string text = key.dump();
    cjose_err error;
    cjose_jwk_t* jwk = cjose_jwk_import(text.data(), text.size(), &error);
    if (jwk == nullptr) continue;  // an unknown key type
    auto held = std::make_unique<Key>(jwk);
    const cjose_jwk_kty_t kind = cjose_jwk_get_kty(jwk, &error);
    // Ignores symmetric keys: anyone who can read a public key set could sign with them.
    if (kind == CJOSE_JWK_KTY_RSA || kind == CJOSE_JWK_KTY_EC) keys->keys_.push_back(std::move(held));
  }
  if (!keys->keys_.empty()) return keys;
  return absl::InvalidArgumentError(absl::StrCat("--jwt-keys: ", options.keys, " has no RSA or EC key"));
}

absl::StatusOr<std::string> JwtKeys::VerifiedClaims(std::string_view token) const {
  if (token.size() > kMaxTokenBytes) return Refused("is too long");
  if (!IsCompact(token)) return Refused("is not a token of this server and not a JWT");
  cjose_err error;
  const std::unique_ptr<cjose_jws_t, decltype(&cjose_jws_release)> jws(
      cjose_jws_import(token.data(), token.size(), &error), &cjose_jws_release);
  if (jws == nullptr) return Refused("is not a token of this server and not a JWT");
  const char* algorithm = cjose_header_get(cjose_jws_get_protected(jws.get()), CJOSE_HDR_ALG, &error);
  if (algorithm == nullptr ||
      std::find(std::begin(kAlgorithms), std::end(kAlgorithms), algorithm) == std::end(kAlgorithms)) {
    return Refused("is not signed with an RS, PS or ES algorithm");
  }
  const bool verified = std::any_of(keys_.begin(), keys_.end(), [&](const std::unique_ptr<Key>& key) {
    const bool elliptic = cjose_jwk_get_kty(key->jwk, &error) == CJOSE_JWK_KTY_EC;
    return elliptic == (algorithm[0] == 'E') && cjose_jws_verify(jws.get(), key->jwk, &error);
  });
  if (!verified) return Refused("is not signed by a key of the identity provider");
  std::uint8_t* bytes = nullptr;
  std::size_t size = 0;
  if (!cjose_jws_get_plaintext(jws.get(), &bytes, &size, &error)) return Refused("is empty");
  return std::string(reinterpret_cast<const char*>(bytes), size);
}

absl::StatusOr<Account> JwtKeys::Check(std::string_view token, absl::Time now) const {
  const auto text = VerifiedClaims(token);
  if (!text.ok()) return text.status();
  const json claims = json::parse(*text, nullptr, false);
  if (!claims.is_object()) return Refused("has no claims");
  if (TextOf(claims, "iss") != options_.issuer) return Refused("comes from another issuer");
  if (!HasText(claims, "aud", options_.audience)) return Refused("is for another audience");
  if (absl::Status status = CheckTimes(claims, now); !status.ok()) return status;
  const Account account{TextOf(claims, options_.name_claim), RoleIn(claims, options_.role_claim)};
  if (account.name.empty()) return Refused(absl::StrCat("has no name in \"", options_.name_claim, "\""));
  if (account.role == v1::ACCESS_ROLE_UNSPECIFIED) {
    return Refused(absl::StrCat("has no role in \"", options_.role_claim, "\": viewer, controller, owner, admin"));
  }
  return account;
}

}  // namespace phrenic::access
