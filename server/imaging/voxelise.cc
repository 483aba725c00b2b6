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

}  // namespace phrenic::imaging
