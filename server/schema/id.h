// Ids that clients give to sessions, studies and exports: 1 to 64 characters of a-z, 0-9 and "-".
#ifndef PHRENIC_SERVER_SCHEMA_ID_H_
#define PHRENIC_SERVER_SCHEMA_ID_H_

#include <functional>
#include <string>

#include "absl/status/status.h"

namespace phrenic::schema {

// Returns INVALID_ARGUMENT "FIELD: ..." for a malformed id. An empty id is valid: the server then chooses one.
absl::Status CheckId(const std::string& field, const std::string& id);

// Returns the first of "stem", "stem-2", "stem-3" ... that is not taken. Replaces characters that are not allowed by
// "-"; uses `otherwise` for an empty stem.
std::string FreeId(const std::string& stem, const std::string& otherwise,
                   const std::function<bool(const std::string&)>& taken);

// Returns the id truncated to the longest valid length, for error messages.
std::string ShortId(const std::string& id);

}  // namespace phrenic::schema

#endif  // PHRENIC_SERVER_SCHEMA_ID_H_
