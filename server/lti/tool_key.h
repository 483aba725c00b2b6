// The RSA keys with which this server signs for learning platforms, by cjose.
#ifndef PHRENIC_SERVER_LTI_TOOL_KEY_H_
#define PHRENIC_SERVER_LTI_TOOL_KEY_H_

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "absl/status/statusor.h"

namespace phrenic::lti {

// Immutable and thread-safe. The file is a JSON Web Key Set of private RSA keys: the first signs, and all are
// published, so that a key can be replaced: write the new one before the old one, and remove the old one a day later.
class ToolKey {
 public:
  // Reads the file. Makes one with a new key of 2048 bits, mode 0600, if it is missing. INVALID_ARGUMENT names the file
  // if it has no private RSA key; PERMISSION_DENIED if it cannot be read or written.
  static absl::StatusOr<std::unique_ptr<ToolKey>> Open(const std::string& file);
  ToolKey(const ToolKey&) = delete;
  ToolKey& operator=(const ToolKey&) = delete;
  ~ToolKey();

  // Returns the claims as a token, signed with RS256. INTERNAL if cjose fails.
  absl::StatusOr<std::string> Sign(const nlohmann::json& claims) const;
  // Returns the public key set.
  const std::string& public_set() const { return public_set_; }

 private:
  ToolKey();
  absl::Status Add(const nlohmann::json& key);
  struct Key;
  std::vector<std::unique_ptr<Key>> keys_;
  std::string public_set_;
};

}  // namespace phrenic::lti

#endif  // PHRENIC_SERVER_LTI_TOOL_KEY_H_
