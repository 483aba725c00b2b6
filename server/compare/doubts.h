// What makes distances between two surfaces doubtful: wrong units and frames.
#ifndef PHRENIC_SERVER_COMPARE_DOUBTS_H_
#define PHRENIC_SERVER_COMPARE_DOUBTS_H_

#include <string>
#include <vector>

#include "server/compare/measured_surface.h"

namespace phrenic::compare {

// Returns a sentence for each doubt: the surfaces' sizes differ by more than a factor of 3 (a wrong unit), they lie
// further apart than half their size, or B would lie nearer with x and y negated (RAS read as LPS). `mean` is their
// mean distance [m]. None if a surface is empty. Thread-safe.
std::vector<std::string> Doubts(const MeasuredSurface& a, const MeasuredSurface& b, double mean);

}  // namespace phrenic::compare

#endif  // PHRENIC_SERVER_COMPARE_DOUBTS_H_
