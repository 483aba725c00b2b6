// Clavicle and scapula: the bones that carry the arm. Displayed, not simulated.
//
// The clavicle is an S-shaped tube from the clavicular notch of the manubrium to the acromion. The scapula is a thin
// plate behind ribs 2 to 7 with a spine, acromion, coracoid process and glenoid cavity.
//
// Sources: rounded adult dimensions of general anatomy: clavicle 14 cm long, scapula 15 cm high and 10 cm wide, medial
// border 6 cm from the midline, plane of the scapula 30 to 40 degrees in front of the coronal plane, superior angle at
// T2 and inferior angle at T7 with the arm at the side.
#ifndef PHRENIC_SERVER_ANATOMY_SHOULDER_GIRDLE_H_
#define PHRENIC_SERVER_ANATOMY_SHOULDER_GIRDLE_H_

#include "server/mesh/mesh.h"

namespace phrenic::anatomy {

// Return closed surfaces of genus 0 [mm] with edges of about `edge_length` [mm]; those of the scapula at most 6 mm. The
// right bones are the mirror images. Between rib and scapula is the place of the muscles, 7 mm or more.
Mesh LeftClavicle(double edge_length);
Mesh LeftScapula(double edge_length);

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_SHOULDER_GIRDLE_H_
