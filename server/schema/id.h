// Names that clients give to sessions and studies: 1 to 64 of a-z, 0-9 and "-".
#ifndef PHRENIC_SERVER_SCHEMA_ID_H_
#define PHRENIC_SERVER_SCHEMA_ID_H_

#include <functional>
#include <string>

#include "absl/status/status.h"

namespace phrenic::schema {

// OK for an empty id too: the server chooses then. INVALID_ARGUMENT "session_id: ...".
absl::Status CheckId(const std::string& field, const std::string& id);

// The first of "stem", "stem-2", "stem-3" ... that is not taken, with what no id may hold replaced by "-"; `otherwise`
// where nothing is left of the stem.
std::string FreeId(const std::string& stem, const std::string& otherwise,
                   const std::function<bool(const std::string&)>& taken);

// Cut to what an error message may repeat.
std::string ShortId(const std::string& id);

}  // namespace phrenic::schema

#endif  // PHRENIC_SERVER_SCHEMA_ID_H_
