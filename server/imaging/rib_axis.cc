#include "server/imaging/rib_axis.h"

namespace phrenic::imaging {
namespace {

// Returns the mean of the vertices at distances from `from` to `to` [m] of a point; the point if there are none.
Eigen::Vector3d MeanAround(const Mesh& mesh, const Eigen::Vector3d& point, double from, double to) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0;
  for (Eigen::Index i = 0; i < mesh.vertices.cols(); ++i) {
    const double distance = (mesh.vertices.col(i) - point).norm();
    if (distance >= from && distance < to) sum += mesh.vertices.col(i), ++count;
  }
  return count > 0 ? Eigen::Vector3d(sum / count) : point;
}

}  // namespace

RibNeck FindRibNeck(const Mesh& rib, double scale) {
  Eigen::Index medial = 0;
  rib.vertices.row(0).cwiseAbs().minCoeff(&medial);
  const Eigen::Vector3d tip = rib.vertices.col(medial);
  return {MeanAround(rib, tip, 0, 8e-3 * scale), MeanAround(rib, tip, 14e-3 * scale, 22e-3 * scale)};
}

}  // namespace phrenic::imaging
