// The lobes of the generated lungs and the fissures between them. Displayed, not simulated.
//
// The oblique fissure of both lungs runs from the spinous process of T3 behind over the fifth rib in the midaxillary
// line to the sixth costochondral junction in front; the horizontal fissure of the right lung runs at the level of the
// fourth costal cartilage back to the oblique one, which it meets in the midaxillary line (surface anatomy of the
// fissures as in general textbooks). Both are height functions z(|x|, y) that are exact at these places.
#ifndef PHRENIC_SERVER_ANATOMY_LOBES_H_
#define PHRENIC_SERVER_ANATOMY_LOBES_H_

#include "server/mesh/mesh.h"

namespace phrenic::anatomy {

enum class Lobe { kUpper = 1, kMiddle = 2, kLower = 3 };
enum class Fissure { kOblique = 1, kHorizontal = 2 };

// Returns the part of a lung that is a lobe [mm]: closed, genus 0, edges of about `edge_length` [mm], at most 10 mm.
// Between two lobes are 1.2 mm. Requires: the left lung has no middle lobe.
Mesh LungLobe(Lobe lobe, bool left, double edge_length);

// Returns a fissure as a sheet 1.2 mm thick that ends 0.2 mm outside of the lung's surface, where it is seen as a line
// [mm]: closed, genus 0, edges of about `edge_length` [mm], at most 6 mm. Requires: the left lung has no horizontal
// one.
Mesh LungFissure(Fissure fissure, bool left, double edge_length);

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_LOBES_H_
