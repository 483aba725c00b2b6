// Thoracic and upper lumbar vertebrae: body with its waist, pedicles, arch, spinous, transverse and articular
// processes.
#ifndef PHRENIC_SERVER_ANATOMY_VERTEBRA_H_
#define PHRENIC_SERVER_ANATOMY_VERTEBRA_H_

#include "server/mesh/mesh.h"

namespace phrenic::anatomy {

// Number 1 (T1) to 15 (L3), in place [mm], with edges of at most 8 mm: the zero set of a smooth union of distances. One
// closed surface of genus 1, the vertebral canal going through. Spinous processes slope most at T5 to T8; the thoracic
// transverse processes point backwards, the lumbar ones sideways.
Mesh Vertebra(int number, double edge_length);

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_VERTEBRA_H_
