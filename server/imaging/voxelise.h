// Voxelises closed surfaces.
#ifndef PHRENIC_SERVER_IMAGING_VOXELISE_H_
#define PHRENIC_SERVER_IMAGING_VOXELISE_H_

#include "server/imaging/label_volume.h"
#include "server/imaging/mask.h"
#include "server/mesh/mesh.h"

namespace phrenic::imaging {

// Sets the label `number` in each unlabelled voxel whose centre is inside the closed surface [m], by the parity of the
// crossings along k.
void Voxelise(const Mesh& mesh, Label number, LabelVolume& volume);

// Returns the voxels of the volume's grid inside the closed surface [m], also those beyond its border, with a margin of
// empty voxels.
Mask VoxeliseMask(const Mesh& mesh, const LabelVolume& volume, int margin);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_VOXELISE_H_
