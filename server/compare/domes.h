// The two domes of a diaphragm, as regions of its own.
#ifndef PHRENIC_SERVER_COMPARE_DOMES_H_
#define PHRENIC_SERVER_COMPARE_DOMES_H_

#include <optional>

#include "server/mesh/mesh.h"

namespace phrenic::compare {

// In the coronal section of a region through its highest point, where the sheet is lowest between a summit on the left
// (+x) and one on the right: that x [m]. None where there are not two summits that rise 2 mm and more above what lies
// between.
std::optional<double> FindSaddle(const Mesh& mesh, const std::vector<int>& vertices);

// Where both surfaces have a region "diaphragm" that has a saddle in `a`, gives both the regions "left dome" and "right
// dome": its vertices on either side of the saddle of `a`, so that both are cut at one place. Regions of these names
// that a file has already stay as they are.
void AddDomes(Mesh& a, Mesh& b);

}  // namespace phrenic::compare

#endif  // PHRENIC_SERVER_COMPARE_DOMES_H_
