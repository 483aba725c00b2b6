#include "server/access/key_set.h"

#include <cjose/cjose.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "absl/strings/ascii.h"
#include "absl/strings/escaping.h"
#include "absl/strings/str_split.h"

namespace phrenic::access {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxTokenBytes = 16 << 10;
constexpr std::string_view kAlgorithms[] = {"RS256", "RS384", "RS512", "PS256", "PS384",
                                            "PS512", "ES256", "ES384", "ES512"};

absl::Status Unverified(const char* why) { return absl::UnauthenticatedError(why); }

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

}  // namespace

bool HasReadableNumbers(const json& key) {
  constexpr const char* kNumbers[] = {"x", "y", "d", "n", "e", "p", "q", "dp", "dq", "qi", "k"};
  return std::ranges::all_of(kNumbers, [&](const char* name) {
    return !key.is_object() || !key.contains(name) ||
           (key[name].is_string() && IsBase64Url(key[name].get<std::string>()));
  });
}

struct KeySet::Key {
  explicit Key(cjose_jwk_t* imported) : jwk(imported) {}
  ~Key() { cjose_jwk_release(jwk); }
  Key(const Key&) = delete;
  Key& operator=(const Key&) = delete;
  cjose_jwk_t* const jwk;
};

KeySet::KeySet() = default;
KeySet::~KeySet() = default;

std::shared_ptr<const KeySet> KeySet::Parse(const std::string& text) {
  const json set = json::parse(text, nullptr, false);
  if (!set.is_object() || !set.contains("keys") || !set["keys"].is_array()) return nullptr;
  std::shared_ptr<KeySet> keys(new KeySet);
  for (const json& key : set["keys"]) {
    if (!HasReadableNumbers(key)) continue;
    const std::string one = key.dump();
    cjose_err error;
    cjose_jwk_t* jwk = cjose_jwk_import(one.data(), one.size(), &error);
    if (jwk == nullptr) continue;  // an unknown key type
    auto held = std::make_unique<Key>(jwk);
    const cjose_jwk_kty_t kind = cjose_jwk_get_kty(jwk, &error);
    if (kind == CJOSE_JWK_KTY_RSA || kind == CJOSE_JWK_KTY_EC) keys->keys_.push_back(std::move(held));
  }
  return keys->keys_.empty() ? nullptr : std::move(keys);
}

absl::StatusOr<std::string> KeySet::Verified(std::string_view token) const {
  if (token.size() > kMaxTokenBytes) return Unverified("is too long");
  if (!IsCompact(token)) return Unverified("is not a token of this server and not a JWT");
  cjose_err error;
  const std::unique_ptr<cjose_jws_t, decltype(&cjose_jws_release)> jws(
      cjose_jws_import(token.data(), token.size(), &error), &cjose_jws_release);
  std::string header;
  const std::string_view encoded = token.substr(0, token.find('.'));
  if (jws == nullptr || !absl::WebSafeBase64Unescape({encoded.data(), encoded.size()}, &header)) {
    return Unverified("is not a token of this server and not a JWT");
  }
  if (absl::Status status = CheckJwtHeader(header); !status.ok()) return status;
  const char* algorithm = cjose_header_get(cjose_jws_get_protected(jws.get()), CJOSE_HDR_ALG, &error);
  if (algorithm == nullptr ||
      std::find(std::begin(kAlgorithms), std::end(kAlgorithms), algorithm) == std::end(kAlgorithms)) {
    return Unverified("is not signed with an RS, PS or ES algorithm");
  }
  const bool verified = std::any_of(keys_.begin(), keys_.end(), [&](const std::unique_ptr<Key>& key) {
    const bool elliptic = cjose_jwk_get_kty(key->jwk, &error) == CJOSE_JWK_KTY_EC;
    return elliptic == (algorithm[0] == 'E') && cjose_jws_verify(jws.get(), key->jwk, &error);
  });
  if (!verified) return Unverified("is not signed by a key of the identity provider");
  std::uint8_t* bytes = nullptr;
  std::size_t size = 0;
  if (!cjose_jws_get_plaintext(jws.get(), &bytes, &size, &error)) return Unverified("is empty");
  return std::string(reinterpret_cast<const char*>(bytes), size);
}

absl::Status CheckJwtHeader(std::string_view header) {
  const json fields = json::parse(header, nullptr, false);
  if (!fields.is_object()) return Unverified("is not a token of this server and not a JWT");
  if (!fields.contains("crit")) return absl::OkStatus();
  return Unverified("has extensions that must be understood (crit), and this server understands none");
}

}  // namespace phrenic::access
