// Writes displacement fields as NIfTI-1, as ITK, ANTs and 3D Slicer read them.
#ifndef PHRENIC_SERVER_IMAGING_NIFTI_VECTORS_H_
#define PHRENIC_SERVER_IMAGING_NIFTI_VECTORS_H_

#include <Eigen/Geometry>
#include <string>

#include "server/mesh/mesh.h"

namespace phrenic::imaging {

// Returns an uncompressed file of five dimensions, intent 1007 (vector), float32: `vectors` (3 x points, i fastest)
// [mm] in LPS, as ITK expects; the map from indices to points `to_patient` [mm, LPS] is stored in RAS, as NIfTI
// requires.
std::string WriteNiftiVectors(const Eigen::Vector3i& size, const Eigen::Affine3d& to_patient, const Points& vectors);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_NIFTI_VECTORS_H_
