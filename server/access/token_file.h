// Accounts in a file: the hash of each one's token, a name and a role. The tokens themselves are told once and kept
// nowhere.
#ifndef PHRENIC_SERVER_ACCESS_TOKEN_FILE_H_
#define PHRENIC_SERVER_ACCESS_TOKEN_FILE_H_

#include <map>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"
#include "server/access/caller.h"

namespace phrenic::access {

// By the SHA-256 of the token, in hexadecimal: tokens are 128 random bits, so that nobody finds one by trying.
using TokenTable = std::map<std::string, Account, std::less<>>;

// Lines "SHA256 ROLE NAME"; empty ones and those that begin with # say nothing. INVALID_ARGUMENT "FILE:LINE: ...".
absl::StatusOr<TokenTable> ParseTokens(std::string_view file, std::string_view text);
// NOT_FOUND where there is no such file.
absl::StatusOr<TokenTable> ReadTokens(const std::string& file);

// A new account's token. The file is made where there is none, for its owner's eyes; ALREADY_EXISTS for a name that is
// there, INVALID_ARGUMENT for one that is none: 1 to 64 letters, digits and -_.@.
absl::StatusOr<std::string> AddToken(const std::string& file, const Account& account);
// NOT_FOUND where there is no such account.
absl::Status RemoveToken(const std::string& file, const std::string& name);

}  // namespace phrenic::access

#endif  // PHRENIC_SERVER_ACCESS_TOKEN_FILE_H_
