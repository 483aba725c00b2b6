// The generated liver, stomach, spleen and kidneys: what lies under the domes. Displayed, not simulated.
#ifndef PHRENIC_SERVER_ANATOMY_ABDOMINAL_ORGANS_H_
#define PHRENIC_SERVER_ANATOMY_ABDOMINAL_ORGANS_H_

#include "server/mesh/mesh.h"

namespace phrenic::anatomy {

// Return closed surfaces of genus 0 [mm] with edges of about `edge_length` [mm], at most 10 mm. They are at least 4.5
// mm away from the middle surface of the diaphragm, and liver and spleen 2 mm away from the stomach. The liver fills
// the right dome and tapers to the left below the heart; stomach and spleen are under the left dome.
Mesh Liver(double edge_length);
Mesh Stomach(double edge_length);
Mesh Spleen(double edge_length);

// Return closed surfaces of genus 0 [mm] with edges of about `edge_length` [mm], at most 10 mm: kidneys 11 cm long
// beside T12 to L3, the right one half a vertebra lower, with their upper poles nearer to the spine. They are 2 mm away
// from the spleen and behind what the other organs reach.
Mesh LeftKidney(double edge_length);
Mesh RightKidney(double edge_length);

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_ABDOMINAL_ORGANS_H_
