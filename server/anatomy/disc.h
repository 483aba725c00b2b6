// Intervertebral discs: what fills the space between two vertebral bodies.
#ifndef PHRENIC_SERVER_ANATOMY_DISC_H_
#define PHRENIC_SERVER_ANATOMY_DISC_H_

#include "server/mesh/mesh.h"

namespace phrenic::anatomy {

inline constexpr int kDiscs = 14;  // T1/T2 to L2/L3

// Returns disc 1 to 14, below the vertebra of the same number [mm], with edges of at most 3.4 mm: an elliptic cylinder
// a little wider than the vertebral bodies, without them. Closed, genus 0; touches both vertebrae without piercing
// them.
Mesh Disc(int number, double edge_length);

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_DISC_H_
