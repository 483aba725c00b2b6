// A public JSON Web Key Set (RFC 7517), and the signatures (RFC 7515) that its keys verify, by cjose.
#ifndef PHRENIC_SERVER_ACCESS_KEY_SET_H_
#define PHRENIC_SERVER_ACCESS_KEY_SET_H_

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"

namespace phrenic::access {

// Immutable and thread-safe.
class KeySet {
 public:
  // Reads {"keys": [...]}; null if the text is no key set or has no RSA or EC key. Symmetric keys are ignored: anyone
  // who can read a public set could sign with them.
  static std::shared_ptr<const KeySet> Parse(const std::string& text);
  KeySet(const KeySet&) = delete;
  KeySet& operator=(const KeySet&) = delete;
  ~KeySet();

  // Returns the claims, as text, of a token in compact form whose signature is by a key of the set with RS, PS or ES
  // (RFC 7518 section 3.1). UNAUTHENTICATED otherwise, with a reason that follows "the token"; also for a token above
  // 16 KiB and for a header with extensions that must be understood ("crit", RFC 7515 section 4.1.11).
  absl::StatusOr<std::string> Verified(std::string_view token) const;

 private:
  KeySet();
  struct Key;
  std::vector<std::unique_ptr<Key>> keys_;  // RSA and EC, in the order of the set
};

// True if all numbers of a key (RFC 7518 section 6) are texts in base64url: cjose ends the process at some others.
// Call it before cjose_jwk_import. Thread-safe.
bool HasReadableNumbers(const nlohmann::json& key);

// Checks a token's header, as JSON text. Thread-safe. UNAUTHENTICATED as KeySet::Verified.
absl::Status CheckJwtHeader(std::string_view header);

}  // namespace phrenic::access

#endif  // PHRENIC_SERVER_ACCESS_KEY_SET_H_
