// What to say of a name that is not there.
#ifndef PHRENIC_SERVER_SCHEMA_NAMES_H_
#define PHRENIC_SERVER_SCHEMA_NAMES_H_

#include <string>
#include <string_view>
#include <vector>

namespace phrenic::schema {

// The one of `names` that `wanted` may be a slip of: within half of its letters by Levenshtein's distance, or what it
// begins with alone; empty where there is none.
std::string NearestName(std::string_view wanted, const std::vector<std::string>& names);

// Goes behind `there is no scene "thorx"`: "; did you mean thorax? There are cube, thorax", "; there are cube", or
// "; there are none".
std::string ThereAre(std::string_view wanted, const std::vector<std::string>& names);

}  // namespace phrenic::schema

#endif  // PHRENIC_SERVER_SCHEMA_NAMES_H_
