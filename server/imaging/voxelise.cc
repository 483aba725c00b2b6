#include "server/imaging/voxelise.h"

#include <algorithm>
#include <cmath>

#include "server/mesh/units.h"

namespace phrenic::imaging {
namespace {

double Cross(const Eigen::Vector2d& u, const Eigen::Vector2d& v) { return u.x() * v.y() - u.y() * v.x(); }

// Adds the intersections of a triangle with the lines along k, one line per (i, j), in voxel coordinates.
void AddCrossings(const Eigen::Matrix3d& corners, const Eigen::Vector3i& size,
                  std::vector<std::vector<double>>& crossings) {
  const Eigen::Vector2d a = corners.col(0).head<2>(), b = corners.col(1).head<2>(), c = corners.col(2).head<2>();
  const double twice = Cross(b - a, c - a);
  if (twice == 0) return;
  const Eigen::Vector2i low = a.cwiseMin(b).cwiseMin(c).array().ceil().cast<int>().max(0);
  const Eigen::Vector2i high = a.cwiseMax(b).cwiseMax(c).array().floor().cast<int>().min(size.head<2>().array() - 1);
  for (int j = low.y(); j <= high.y(); ++j) {
    for (int i = low.x(); i <= high.x(); ++i) {
      const Eigen::Vector2d p(i, j);
      const double u = Cross(b - p, c - p) / twice, v = Cross(c - p, a - p) / twice, w = 1 - u - v;
      if (u < 0 || v < 0 || w < 0) continue;
      crossings[static_cast<std::size_t>(j) * size.x() + i].push_back(corners.row(2).dot(Eigen::Vector3d(u, v, w)));
    }
  }
}

}  // namespace

void Voxelise(const Mesh& mesh, Label number, LabelVolume& volume) {
  // A small offset, so that no line passes through a vertex or an edge.
  const Eigen::Vector3d offset(1.234e-5, 2.345e-5, 0);
  const Points voxels = (volume.to_patient.inverse() * (mesh.vertices / kMillimetre)).colwise() + offset;
  std::vector<std::vector<double>> crossings(static_cast<std::size_t>(volume.size.x()) * volume.size.y());
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    Eigen::Matrix3d corners;
    for (int k = 0; k < 3; ++k) corners.col(k) = voxels.col(mesh.triangles(k, t));
    AddCrossings(corners, volume.size, crossings);
  }
  for (std::size_t line = 0; line < crossings.size(); ++line) {
    std::vector<double>& along = crossings[line];
    std::sort(along.begin(), along.end());
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
