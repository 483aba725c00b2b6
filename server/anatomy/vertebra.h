// Thoracic and upper lumbar vertebrae (body, pedicles, laminae, spinous, transverse and articular processes), and the
// discs between them.
#ifndef PHRENIC_SERVER_ANATOMY_VERTEBRA_H_
#define PHRENIC_SERVER_ANATOMY_VERTEBRA_H_

#include "server/anatomy/meshing/field.h"
#include "server/mesh/mesh.h"

namespace phrenic::anatomy {

// Returns vertebra 1 (T1) to 15 (L3) at its position [mm], with edges of at most 8 mm: the zero level set of a smooth
// union of signed distances. Closed, genus 1 (the vertebral canal). Spinous processes slope most at T5 to T8;
// transverse processes point backwards in the thorax and sideways in the lumbar spine. The articular processes of two
// vertebrae meet in flat facets 1 mm apart, which face backwards in the thorax and inwards below T12.
Mesh Vertebra(int number, double edge_length);

// Returns the body of vertebra 1 to 15 at its position, without its arch and processes.
Field VertebralBodyField(int number);

inline constexpr int kDiscs = 14;  // T1/T2 to L2/L3

// Returns disc 1 to 14, below the vertebra of the same number [mm], with edges of at most 3.4 mm: an elliptic cylinder
// a little wider than the vertebral bodies, without them. Closed, genus 0; touches both vertebrae without piercing
// them.
Mesh Disc(int number, double edge_length);

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_VERTEBRA_H_
