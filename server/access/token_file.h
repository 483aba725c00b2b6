// The token file: the hash of each account's token, its role and its name. The token itself is shown once, when it is
// made, and not stored.
#ifndef PHRENIC_SERVER_ACCESS_TOKEN_FILE_H_
#define PHRENIC_SERVER_ACCESS_TOKEN_FILE_H_

#include <map>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"
#include "server/access/caller.h"

namespace phrenic::access {

// Accounts by the SHA-256 of the token in hexadecimal. A token has 128 random bits, so hashing needs no salt. Keys are
// in lower case.
using TokenTable = std::map<std::string, Account, std::less<>>;

// Parses lines "SHA256 ROLE NAME"; ignores empty lines and lines that begin with #. INVALID_ARGUMENT "FILE:LINE: ..."
// for a bad line. A line is bad if it has not three words, or if it has no SHA-256, an unknown role, a name that
// AddToken refuses, or a token that is listed twice. `file` is for errors.
absl::StatusOr<TokenTable> ParseTokens(std::string_view file, std::string_view text);
// NOT_FOUND if the file cannot be read; the errors of ParseTokens.
absl::StatusOr<TokenTable> ReadTokens(const std::string& file);

// Adds an account and returns its new token. Creates the file, with mode 0600, if there is none. Errors: ALREADY_EXISTS
// if the name has an account; INVALID_ARGUMENT if the name is not 1 to 64 letters, digits and -_.@; PERMISSION_DENIED
// if the file cannot be written. Not safe against another writer at the same time. The file is replaced at once
// (FILE.new, then a rename), so that a server never reads half of it.
absl::StatusOr<std::string> AddToken(const std::string& file, const Account& account);
// NOT_FOUND if there is no such account. The file is replaced as by AddToken. Also the errors of ReadTokens.
absl::Status RemoveToken(const std::string& file, const std::string& name);

}  // namespace phrenic::access

#endif  // PHRENIC_SERVER_ACCESS_TOKEN_FILE_H_
