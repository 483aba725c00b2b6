// Surfaces of labels: where the softened label is as large as the label was.
#ifndef PHRENIC_SERVER_IMAGING_LABEL_SURFACE_H_
#define PHRENIC_SERVER_IMAGING_LABEL_SURFACE_H_

#include "absl/status/statusor.h"
#include "server/imaging/mask.h"
#include "server/mesh/mesh.h"

namespace phrenic::imaging {

// How many empty voxels a mask needs around it for SurfaceOf.
int SurfaceMargin(const LabelVolume& volume);

// The surface of the mask in metres, LPS: closed, outward, one component, of near-uniform triangles of the edge length
// [mm]. The mask is blurred by a Gaussian of 0.7 of the longest edge of a voxel, which takes the steps away, and cut at
// that level at which as many voxels lie inside as before, so that smoothing keeps the volume and thin bones stay.
// Own code rather than VTK's: marching and remeshing are those of the generated thorax (server/anatomy), VTK would add
// 766 MB to what builds this, and its windowed sinc filter keeps volume no better.
// FAILED_PRECONDITION for a mask of fewer than eight voxels.
absl::StatusOr<Mesh> SurfaceOf(const LabelVolume& volume, const Mask& mask, double edge_length);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_LABEL_SURFACE_H_
