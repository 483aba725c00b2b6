// What a scene would refuse of a surface, found by compiling one.
#ifndef PHRENIC_SERVER_COMPARE_REFUSALS_H_
#define PHRENIC_SERVER_COMPARE_REFUSALS_H_

#include <string>
#include <vector>

#include "server/mesh/mesh.h"

namespace phrenic::compare {

// Compiles a small scene for each use that a scene can have for a surface [m] and returns, for each that fails, the use
// and the error of the compilation:
//
//   a body                  any body of this surface; if it fails, no other use is tried
//   mass from a material    a deformable body with a density
//   contact surface         that others stay outside of
//   target                  to which springs draw
//   chamber                 whose pressure acts on its triangles
//   surface to follow       SKIN_MODE_TRIANGLES
//   rigid links             between all vertices at one place
//   lung of tissue          LungTissue, with bricks of its default size
//   solid                   a filling by cells, 8 along the longest side, fewer above 40,000 triangles; not tried for
//                           closed parts that face outwards, for which there is always a size of cells
//
// Takes 0.3 s for 40,000 triangles. Thread-safe.
std::vector<std::string> Refusals(const Mesh& surface);

}  // namespace phrenic::compare

#endif  // PHRENIC_SERVER_COMPARE_REFUSALS_H_
