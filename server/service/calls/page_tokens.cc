#include "server/service/calls/page_tokens.h"

#include <openssl/evp.h>
#include <openssl/rand.h>

#include <cstdlib>
#include <memory>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "server/crypto/sha256.h"

namespace phrenic::service {
namespace {

constexpr std::size_t kKey = 32, kNonce = 12, kTag = 16;
constexpr std::size_t kLongest = 256;  // more than the token of the longest id

using Context = std::unique_ptr<EVP_CIPHER_CTX, decltype(&EVP_CIPHER_CTX_free)>;

std::string Random(std::size_t size) {
  std::string bytes(size, '\0');
  // Without randomness nothing is secret: the program cannot continue.
  if (RAND_bytes(reinterpret_cast<unsigned char*>(bytes.data()), static_cast<int>(size)) != 1) std::abort();
  return bytes;
}

const unsigned char* Bytes(std::string_view text) { return reinterpret_cast<const unsigned char*>(text.data()); }

absl::Status NotOurs() {
  return absl::InvalidArgumentError("page_token: this server did not give you this token; list from the beginning");
}

// Encrypts or decrypts `text`. Returns "" on failure.
std::string Crypt(bool encrypt, EVP_CIPHER_CTX* context, const std::string& key, std::string_view nonce,
                  std::string_view caller, std::string_view text) {
  std::string out(text.size(), '\0');
  int size = 0;
  const bool good =
      EVP_CipherInit_ex(context, EVP_aes_256_gcm(), nullptr, Bytes(key), Bytes(nonce), encrypt ? 1 : 0) == 1 &&
      EVP_CipherUpdate(context, nullptr, &size, Bytes(caller), static_cast<int>(caller.size())) == 1 &&
      EVP_CipherUpdate(context, reinterpret_cast<unsigned char*>(out.data()), &size, Bytes(text),
                       static_cast<int>(text.size())) == 1;
  return good ? out : "";
}

}  // namespace

PageTokens::PageTokens() : key_(Random(kKey)), for_anyone_(false) {}

PageTokens::PageTokens(std::string_view shared)
    : key_(Sha256Hex(absl::StrCat("phrenic page tokens ", absl::string_view(shared.data(), shared.size())))
               .substr(0, kKey)),
      for_anyone_(true) {}

std::string PageTokens::Seal(std::string_view id, std::string_view caller) const {
  const Context context(EVP_CIPHER_CTX_new(), &EVP_CIPHER_CTX_free);
  const std::string nonce = Random(kNonce);
  std::string sealed = Crypt(true, context.get(), key_, nonce, for_anyone_ ? "" : caller, id);
  std::string tag(kTag, '\0');
  int size = 0;
  EVP_CipherFinal_ex(context.get(), reinterpret_cast<unsigned char*>(sealed.data()), &size);
  EVP_CIPHER_CTX_ctrl(context.get(), EVP_CTRL_GCM_GET_TAG, static_cast<int>(kTag), tag.data());
  std::string token;
  absl::WebSafeBase64Escape(absl::StrCat(nonce, tag, sealed), &token);
  return token;
}

absl::StatusOr<std::string> PageTokens::Open(std::string_view token, std::string_view caller) const {
  if (token.empty()) return "";
  std::string bytes;
  const absl::string_view text(token.data(), token.size());
  if (token.size() > kLongest || !absl::WebSafeBase64Unescape(text, &bytes)) return NotOurs();
  if (bytes.size() <= kNonce + kTag) return NotOurs();
  const std::string nonce = bytes.substr(0, kNonce);
  std::string tag = bytes.substr(kNonce, kTag);
  const Context context(EVP_CIPHER_CTX_new(), &EVP_CIPHER_CTX_free);
  std::string id = Crypt(false, context.get(), key_, nonce, for_anyone_ ? "" : caller, bytes.substr(kNonce + kTag));
  EVP_CIPHER_CTX_ctrl(context.get(), EVP_CTRL_GCM_SET_TAG, static_cast<int>(kTag), tag.data());
  unsigned char rest[kTag];
  int size = 0;
  if (id.empty() || EVP_CipherFinal_ex(context.get(), rest, &size) != 1) return NotOurs();
  return id;
}

}  // namespace phrenic::service
