// Suggestions for unknown names in error messages.
#ifndef PHRENIC_SERVER_SCHEMA_NAMES_H_
#define PHRENIC_SERVER_SCHEMA_NAMES_H_

#include <string>
#include <string_view>
#include <vector>

namespace phrenic::schema {

// Returns the name that `wanted` probably misspells, without regard to case: the only one that begins with
// it, or the one with the fewest letters inserted, left out, replaced or exchanged with a neighbour, if these are at
// most half of the name's length. The first of several. Returns "" if no name is so near.
std::string NearestName(std::string_view wanted, const std::vector<std::string>& names);

// Returns the rest of a message that begins with `there is no scene "thorx"`: "; did you mean thorax? There are cube,
// thorax", "; there are cube", or "; there are none".
std::string ThereAre(std::string_view wanted, const std::vector<std::string>& names);

}  // namespace phrenic::schema

#endif  // PHRENIC_SERVER_SCHEMA_NAMES_H_
