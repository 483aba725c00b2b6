// Manubrium, body of the sternum and xiphoid process: plates along the sternum's tilted midline, with jugular,
// clavicular and costal notches, joined by thin synchondroses.
#ifndef PHRENIC_SERVER_ANATOMY_STERNUM_H_
#define PHRENIC_SERVER_ANATOMY_STERNUM_H_

#include "server/mesh/mesh.h"

namespace phrenic::anatomy {

// Return closed surfaces [mm] with edges of about `edge_length` [mm]. Rounded adult means: manubrium 45 mm high and 56
// mm wide, body 100 mm high and up to 38 mm wide, xiphoid 30 mm high.
Mesh Manubrium(double edge_length);
Mesh SternumBody(double edge_length);
Mesh Xiphoid(double edge_length);

// Returns half the width of the sternum at height z [mm], from the manubrium down to the xiphoid.
double SternumHalfWidth(double z);

// Returns the height of the notch for costal cartilage 1 to 7 [mm].
double SternalNotch(int number);

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_STERNUM_H_
