#include "server/physiology/diaphragm_border.h"

#include <cmath>
#include <iterator>

#include "server/mesh/topology.h"

namespace phrenic::physiology {

DiaphragmBorder::DiaphragmBorder(const Mesh& sheet) {
  const Eigen::Vector3d low = sheet.vertices.rowwise().minCoeff(), high = sheet.vertices.rowwise().maxCoeff();
  middle_ = ((low + high) / 2).head<2>();
  for (const int i : BoundaryVertices(sheet.triangles)) heights_[Azimuth(sheet.vertices.col(i))] = sheet.vertices(2, i);
}

double DiaphragmBorder::Azimuth(const Eigen::Vector3d& at) const {
  return std::atan2(at.y() - middle_.y(), at.x() - middle_.x());
}

bool DiaphragmBorder::IsBelow(const Eigen::Vector3d& at) const {
  const double azimuth = Azimuth(at);
  auto next = heights_.lower_bound(azimuth);
  if (next == heights_.begin() || next == heights_.end()) return at.z() > heights_.begin()->second;
  const auto last = std::prev(next);
  const double share = (azimuth - last->first) / (next->first - last->first);
  return at.z() > last->second + share * (next->second - last->second);
}

}  // namespace phrenic::physiology
