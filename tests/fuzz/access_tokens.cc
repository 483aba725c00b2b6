// Any bytes as a token file give accounts with names and roles, or an error with file and line. Any bytes as the header
// or the claims of a signed token give an account whose name fits in one line and is none of a token file, or
// UNAUTHENTICATED.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "server/access/jwt.h"
#include "server/access/rules.h"
#include "server/access/token_file.h"

namespace {

void Require(bool holds) {
  if (!holds) std::abort();
}

void TryTokenFile(const std::string& text) {
  const auto tokens = phrenic::access::ParseTokens("fuzz", text);
  if (!tokens.ok()) return Require(tokens.status().message().substr(0, 5) == "fuzz:");
  for (const auto& [hash, account] : *tokens) {
    Require(hash.size() == 64 && !account.name.empty() && !phrenic::access::NameOf(account.role).empty());
    Require(account.name.find(':') == std::string::npos);
  }
}

void TryJwt(const std::string& text) {
  const auto header = phrenic::access::CheckJwtHeader(text);
  Require(header.ok() || absl::IsUnauthenticated(header));
  phrenic::access::JwtOptions options;
  options.issuer = "i", options.audience = "a";
  const auto account = phrenic::access::ReadJwtClaims(text, options, absl::FromUnixSeconds(1'800'000'000));
  if (!account.ok()) return Require(absl::IsUnauthenticated(account.status()));
  Require(account->name.substr(0, 6) == "jwt:i#" && account->name.size() <= 6 + 255);
  for (const char c : account->name) Require(static_cast<unsigned char>(c) >= ' ' && c != '\x7f');
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  TryTokenFile(text);
  TryJwt(text);
  return 0;
}
