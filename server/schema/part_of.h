// The part of a limit that one caller may take.
#ifndef PHRENIC_SERVER_SCHEMA_PART_OF_H_
#define PHRENIC_SERVER_SCHEMA_PART_OF_H_

#include <algorithm>

namespace phrenic {

// Returns the fraction `share` of `whole`, rounded down, and at least one. Pure function, thread-safe.
inline int PartOf(int whole, double share) { return std::max(1, static_cast<int>(share * whole)); }

}  // namespace phrenic

#endif  // PHRENIC_SERVER_SCHEMA_PART_OF_H_
