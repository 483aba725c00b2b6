// Any bytes as a token file give accounts with names and roles, or an error with file and line.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "server/access/rules.h"
#include "server/access/token_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  const auto tokens = phrenic::access::ParseTokens("fuzz", text);
  if (!tokens.ok()) {
    if (tokens.status().message().substr(0, 5) != "fuzz:") std::abort();
    return 0;
  }
  for (const auto& [hash, account] : *tokens) {
    if (hash.size() != 64 || account.name.empty() || phrenic::access::NameOf(account.role).empty()) std::abort();
  }
  return 0;
}
