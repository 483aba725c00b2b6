// Divides a diaphragm into its left and right dome.
#ifndef PHRENIC_SERVER_COMPARE_DOMES_H_
#define PHRENIC_SERVER_COMPARE_DOMES_H_

#include <optional>

#include "server/mesh/mesh.h"

namespace phrenic::compare {

// Returns the x [m] of the saddle between the two domes of a region, in its coronal section (constant y) through its
// highest point: the x at which the outline z(x) is lowest between a summit on the left (+x) and one on the right.
// Returns nullopt if there are not two summits that rise at least 2 mm above the saddle. `vertices` are those of the
// region; the outline is sampled at 128 equidistant x.
std::optional<double> FindSaddle(const Mesh& mesh, const std::vector<int>& vertices);

// Adds the regions "left dome" (x above the saddle) and "right dome" to both surfaces, if both have a region
// "diaphragm" and that of `a` has a saddle. Both surfaces are divided at the saddle of `a`. Existing regions of these
// names are kept.
void AddDomes(Mesh& a, Mesh& b);

}  // namespace phrenic::compare

#endif  // PHRENIC_SERVER_COMPARE_DOMES_H_
