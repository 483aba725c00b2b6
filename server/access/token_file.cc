#include "server/access/token_file.h"

#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "server/access/rules.h"
#include "server/crypto/secret.h"
#include "server/crypto/sha256.h"
#include "server/schema/file_bytes.h"

namespace phrenic::access {
namespace {

constexpr std::size_t kHashLength = 64, kMaxNameLength = 64;

bool IsHash(std::string_view text) {
  return text.size() == kHashLength && std::all_of(text.begin(), text.end(), absl::ascii_isxdigit);
}

bool IsAccountName(std::string_view name) {
  const auto good = [](char c) {
    return absl::ascii_isalnum(static_cast<unsigned char>(c)) || std::string_view("-_.@").find(c) != std::string::npos;
  };
  return !name.empty() && name.size() <= kMaxNameLength && std::all_of(name.begin(), name.end(), good);
}

absl::Status CheckLine(const std::vector<std::string>& words, const TokenTable& before) {
  if (words.size() != 3 || !IsHash(words[0])) return absl::InvalidArgumentError("a line must be SHA256 ROLE NAME");
  if (RoleOf(words[1]) == v1::ACCESS_ROLE_UNSPECIFIED) {
    return absl::InvalidArgumentError(
        absl::StrCat("there is no role \"", words[1], "\": viewer, controller, owner, admin"));
  }
  if (!IsAccountName(words[2])) {
    return absl::InvalidArgumentError("a name must have 1 to 64 letters, digits and -_.@");
  }
  if (before.contains(words[0])) return absl::InvalidArgumentError("the token is listed twice");
  return absl::OkStatus();
}

// Replaces the file atomically, with mode 0600.
absl::Status WriteTokens(const std::string& file, const TokenTable& tokens) {
  std::error_code missing;
  if (std::filesystem::is_other(std::filesystem::status(file, missing))) {
    return absl::InvalidArgumentError(absl::StrCat(file, " is a device or a pipe: name a file"));
  }
  const std::string temporary = file + ".new";
  const mode_t before = umask(0077);
  {
    std::ofstream out(temporary);
    out << "# Accounts of phrenicd: SHA-256 of the token, role, name. `phrenicd token` writes it.\n";
    for (const auto& [hash, account] : tokens)
      out << hash << " " << NameOf(account.role) << " " << account.name << "\n";
  }
  umask(before);
  std::error_code error;
  std::filesystem::rename(temporary, file, error);
  if (!error) return absl::OkStatus();
  return absl::PermissionDeniedError(absl::StrCat(file, " cannot be written: ", error.message()));
}

}  // namespace

absl::StatusOr<TokenTable> ParseTokens(std::string_view file, std::string_view text) {
  TokenTable tokens;
  int number = 0;
  for (absl::string_view line : absl::StrSplit(absl::string_view(text.data(), text.size()), '\n')) {
    ++number;
    line = absl::StripAsciiWhitespace(line);
    if (line.empty() || line.front() == '#') continue;
    std::vector<std::string> words = absl::StrSplit(line, absl::ByAnyChar(" \t"), absl::SkipEmpty());
    if (!words.empty()) absl::AsciiStrToLower(&words[0]);
    if (const absl::Status checked = CheckLine(words, tokens); !checked.ok()) {
      return absl::InvalidArgumentError(absl::StrCat(std::string(file), ":", number, ": ", checked.message()));
    }
    tokens[words[0]] = {words[2], RoleOf(words[1]), words[0]};
  }
  return tokens;
}

absl::StatusOr<TokenTable> ReadTokens(const std::string& file) {
  const std::optional<std::string> text = ReadBytes(file);
  if (!text.has_value()) return absl::NotFoundError(absl::StrCat("--tokens: ", file, " cannot be read"));
  return ParseTokens(file, *text);
}

absl::StatusOr<std::string> AddToken(const std::string& file, const Account& account) {
  if (!IsAccountName(account.name)) {
    return absl::InvalidArgumentError("--name: must have 1 to 64 letters, digits and -_.@");
  }
  TokenTable tokens;
  if (std::error_code error; std::filesystem::exists(file, error)) {
    auto read = ReadTokens(file);
    if (!read.ok()) return read.status();
    tokens = *std::move(read);
  }
  for (const auto& [hash, other] : tokens) {
    if (other.name != account.name) continue;
    return absl::AlreadyExistsError(
        absl::StrCat("--name: ", account.name, " already has a token; remove it first: phrenicd token remove"));
  }
  std::string token = NewToken();
  tokens[Sha256Hex(token)] = account;
  if (absl::Status status = WriteTokens(file, tokens); !status.ok()) return status;
  return token;
}

absl::Status RemoveToken(const std::string& file, const std::string& name) {
  auto tokens = ReadTokens(file);
  if (!tokens.ok()) return tokens.status();
  if (std::erase_if(*tokens, [&name](const auto& each) { return each.second.name == name; }) == 0) {
    return absl::NotFoundError(absl::StrCat("--name: ", file, " has no account ", name));
  }
  return WriteTokens(file, *tokens);
}

}  // namespace phrenic::access
