// The parts of a scene that nothing holds: movable vertices that forces and links join to each other, but to no fixed
// or driven vertex. A force that ties a vertex to a place (gravity, attachments, target springs) joins nothing.
#ifndef PHRENIC_SERVER_MECHANICS_STEP_LOOSE_PARTS_H_
#define PHRENIC_SERVER_MECHANICS_STEP_LOOSE_PARTS_H_

#include <vector>

#include "server/mechanics/model.h"

namespace phrenic {

// Immutable. Made from the forces at rest, inactive ones (slack cables) among them.
struct LooseParts {
  explicit LooseParts(const Model& model);

  int count = 0;
  std::vector<int> of;  // the part of each simulated vertex; -1 if it is held
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_STEP_LOOSE_PARTS_H_
