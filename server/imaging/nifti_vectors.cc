#include "server/imaging/nifti_vectors.h"

#include "server/imaging/nifti_header.h"
#include "server/meshio/bytes.h"

namespace phrenic::imaging {

std::string WriteNiftiVectors(const Eigen::Vector3i& size, const Eigen::Affine3d& to_patient, const Points& vectors) {
  constexpr int kVector = 1007, kFloat32 = 16;
  const Eigen::Vector3d spacing = to_patient.linear().colwise().norm();
  std::string bytes =
      NiftiHeaderBytes({{5, size.x(), size.y(), size.z(), 1, 3, 1, 1}, spacing, to_patient, kVector, kFloat32, 32, 0});
  for (int axis = 0; axis < 3; ++axis) {
    for (const double along : vectors.row(axis)) meshio::AppendBytes(bytes, static_cast<float>(along));
  }
  return bytes;
}

}  // namespace phrenic::imaging
