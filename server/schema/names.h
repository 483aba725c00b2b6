// Suggestions for unknown names in error messages.
#ifndef PHRENIC_SERVER_SCHEMA_NAMES_H_
#define PHRENIC_SERVER_SCHEMA_NAMES_H_

#include <string>
#include <string_view>
#include <vector>

namespace phrenic::schema {

// Returns the name that `wanted` probably misspells: the only one that begins with it, or the nearest by Levenshtein
// distance if that is at most half of the name's length. Returns "" if there is none.
std::string NearestName(std::string_view wanted, const std::vector<std::string>& names);

// Returns the rest of a message that begins with `there is no scene "thorx"`: "; did you mean thorax? There are cube,
// thorax", "; there are cube", or "; there are none".
std::string ThereAre(std::string_view wanted, const std::vector<std::string>& names);

}  // namespace phrenic::schema

#endif  // PHRENIC_SERVER_SCHEMA_NAMES_H_
