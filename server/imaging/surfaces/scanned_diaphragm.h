// Fits the derived middle surface and the scanned double layer of a diaphragm to each other and to the cage.
#ifndef PHRENIC_SERVER_IMAGING_SURFACES_SCANNED_DIAPHRAGM_H_
#define PHRENIC_SERVER_IMAGING_SURFACES_SCANNED_DIAPHRAGM_H_

#include "server/imaging/fitted_cage.h"
#include "server/mesh/mesh.h"

namespace phrenic::imaging {

// Moves the middle surface [m] along its normals to halfway between the scanned layers, `scanned` in voxels of
// `volume`, and then to the wall [m], a tube, as FittedCage::Inside but along its normals. The derived surface is a
// depth along rays, which is inaccurate where rays meet the layers at small angles, beside the spine. Eight rounds:
// each vertex looks for the layers within 15 mm along its normal; what it finds is averaged with its neighbours, which
// also closes the openings, and between rounds the mesh is relaxed. Returns the surface before it was moved to the
// wall.
Mesh FollowScan(const LabelVolume& volume, const Mask& scanned, const Mesh& wall, Mesh& middle);

// Moves the scanned layers [m] with the middle surface, from `before` to `after` with the same triangles, to 4 mm from
// it at most (the pillars in front of the spine, which are thicker, could not bend with the sheet) and 1.8 mm outside
// of the cage, which is 3.5 mm inside of bones. Moves are averaged with those of neighbours, so that the layers keep
// apart.
void DrawLayers(const Mesh& before, const Mesh& after, const FittedCage& cage, Mesh& scanned);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_SURFACES_SCANNED_DIAPHRAGM_H_
