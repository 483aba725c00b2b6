#include "server/lti/tool_key.h"

#include <cjose/cjose.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>

#include "absl/strings/str_cat.h"
#include "server/access/key_set.h"
#include "server/crypto/sha256.h"
#include "server/schema/file_bytes.h"

namespace phrenic::lti {
namespace {

using nlohmann::json;

constexpr std::size_t kKeyBits = 2048, kKeyIdLength = 16;

struct Freed {
  void operator()(char* text) const { free(text); }
};

// Returns a key as JSON; null if cjose fails.
json JsonOf(cjose_jwk_t* key, bool secret) {
  cjose_err error;
  const std::unique_ptr<char, Freed> text(cjose_jwk_to_json(key, secret, &error));
  return text == nullptr ? json() : json::parse(text.get(), nullptr, false);
}

// Returns a set with one new key.
absl::StatusOr<std::string> NewKeySet() {
  cjose_err error;
  const std::unique_ptr<cjose_jwk_t, decltype(&cjose_jwk_release)> key(
      cjose_jwk_create_RSA_random(kKeyBits, nullptr, 0, &error), &cjose_jwk_release);
  if (key == nullptr) return absl::InternalError("--lti-key: no key can be made");
  json text = JsonOf(key.get(), true);
  text["kid"] = Sha256Hex(JsonOf(key.get(), false).dump()).substr(0, kKeyIdLength);
  return json{{"keys", {text}}}.dump(2);
}

absl::Status WriteSecret(const std::string& file, const std::string& text) {
  const int descriptor = open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR);
  const bool written =
      descriptor >= 0 && write(descriptor, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  if (descriptor >= 0) close(descriptor);
  if (written) return absl::OkStatus();
  return absl::PermissionDeniedError(absl::StrCat("--lti-key: cannot write ", file));
}

}  // namespace

struct ToolKey::Key {
  explicit Key(cjose_jwk_t* imported) : jwk(imported) {}
  ~Key() { cjose_jwk_release(jwk); }
  Key(const Key&) = delete;
  Key& operator=(const Key&) = delete;
  cjose_jwk_t* const jwk;
  std::string id;
};

ToolKey::ToolKey() = default;
ToolKey::~ToolKey() = default;

absl::Status ToolKey::Add(const json& key) {
  if (!access::HasReadableNumbers(key)) return absl::InvalidArgumentError("has a key whose numbers are not base64url");
  cjose_err error;
  const std::string text = key.dump();
  cjose_jwk_t* jwk = cjose_jwk_import(text.data(), text.size(), &error);
  if (jwk == nullptr) return absl::InvalidArgumentError("has a key that cannot be read");
  auto held = std::make_unique<Key>(jwk);
  if (cjose_jwk_get_kty(jwk, &error) != CJOSE_JWK_KTY_RSA || !key.contains("d")) {
    return absl::InvalidArgumentError("has a key that is not a private RSA key");
  }
  const char* id = cjose_jwk_get_kid(jwk, &error);
  if (id == nullptr || *id == '\0') return absl::InvalidArgumentError("has a key without \"kid\"");
  held->id = id;
  keys_.push_back(std::move(held));
  return absl::OkStatus();
}

absl::StatusOr<std::unique_ptr<ToolKey>> ToolKey::Open(const std::string& file) {
  auto text = ReadBytes(file);
  if (!text.has_value()) {
    const auto made = NewKeySet();
    if (!made.ok()) return made.status();
    if (absl::Status status = WriteSecret(file, *made); !status.ok()) return status;
    text = *made;
  }
  const json set = json::parse(*text, nullptr, false);
  if (!set.is_object() || !set.contains("keys") || !set["keys"].is_array() || set["keys"].empty()) {
    return absl::InvalidArgumentError(absl::StrCat("--lti-key: ", file, " is not a set of keys, {\"keys\": [...]}"));
  }
  std::unique_ptr<ToolKey> keys(new ToolKey);
  json published = json::array();
  for (const json& key : set["keys"]) {
    absl::Status status = key.is_object() ? keys->Add(key) : absl::InvalidArgumentError("has a key that is no object");
    if (!status.ok()) return absl::InvalidArgumentError(absl::StrCat("--lti-key: ", file, " ", status.message()));
    json open = JsonOf(keys->keys_.back()->jwk, false);
    open["alg"] = "RS256";
    open["use"] = "sig";
    published.push_back(std::move(open));
  }
  keys->public_set_ = json{{"keys", published}}.dump();
  return keys;
}

absl::StatusOr<std::string> ToolKey::Sign(const json& claims) const {
  cjose_err error;
  const std::unique_ptr<cjose_header_t, decltype(&cjose_header_release)> header(cjose_header_new(&error),
                                                                                &cjose_header_release);
  const Key& key = *keys_.front();
  cjose_header_set(header.get(), CJOSE_HDR_ALG, "RS256", &error);
  cjose_header_set(header.get(), CJOSE_HDR_KID, key.id.c_str(), &error);
  cjose_header_set(header.get(), "typ", "JWT", &error);
  const std::string text = claims.dump();
  const std::unique_ptr<cjose_jws_t, decltype(&cjose_jws_release)> jws(
      cjose_jws_sign(key.jwk, header.get(), reinterpret_cast<const std::uint8_t*>(text.data()), text.size(), &error),
      &cjose_jws_release);
  const char* token = nullptr;
  if (jws == nullptr || !cjose_jws_export(jws.get(), &token, &error)) {
    return absl::InternalError("the key of --lti-key cannot sign");
  }
  return std::string(token);
}

}  // namespace phrenic::lti
