// Closed surfaces into voxels.
#ifndef PHRENIC_SERVER_IMAGING_VOXELISE_H_
#define PHRENIC_SERVER_IMAGING_VOXELISE_H_

#include "server/imaging/label_volume.h"
#include "server/mesh/mesh.h"

namespace phrenic::imaging {

// Gives the number to each unlabelled voxel whose middle lies inside the closed surface [m]: between the first and
// second, third and fourth ... crossing of the line of voxels along k.
void Voxelise(const Mesh& mesh, Label number, LabelVolume& volume);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_VOXELISE_H_
