#include "server/imaging/voxelise.h"

#include <algorithm>
#include <cmath>

#include "server/mesh/line_crossings.h"
#include "server/mesh/units.h"

namespace phrenic::imaging {

void Voxelise(const Mesh& mesh, Label number, LabelVolume& volume) {
  const Points voxels = volume.to_patient.inverse() * (mesh.vertices / kMillimetre);
  const auto crossings = LineCrossings(voxels, mesh.triangles, volume.size.head<2>());
  for (std::size_t line = 0; line < crossings.size(); ++line) {
    const std::vector<double>& along = crossings[line];
    for (std::size_t c = 0; c + 1 < along.size(); c += 2) {
      const int from = std::max(0, static_cast<int>(std::ceil(along[c])));
      const int to = std::min(volume.size.z() - 1, static_cast<int>(std::floor(along[c + 1])));
      for (int k = from; k <= to; ++k) {
        Label& voxel = volume.labels[k * crossings.size() + line];
        if (voxel == 0) voxel = number;
      }
    }
  }
}

Mask VoxeliseMask(const Mesh& mesh, const LabelVolume& volume, int margin) {
  const Points voxels = volume.to_patient.inverse() * (mesh.vertices / kMillimetre);
  const Eigen::Vector3d low = voxels.rowwise().minCoeff(), high = voxels.rowwise().maxCoeff();
  LabelVolume around;
  Mask mask;
  mask.low = low.array().floor().cast<int>() - margin;
  mask.size = high.array().ceil().cast<int>() + 1 + margin - mask.low.array();
  around.size = mask.size;
  around.to_patient = volume.to_patient * Eigen::Translation3d(mask.low.cast<double>());
  around.labels.assign(static_cast<std::size_t>(mask.size.x()) * mask.size.y() * mask.size.z(), 0);
  Voxelise(mesh, 1, around);
  mask.inside.assign(around.labels.begin(), around.labels.end());
  return mask;
}

}  // namespace phrenic::imaging
