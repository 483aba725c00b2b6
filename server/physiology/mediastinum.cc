#include "server/physiology/mediastinum.h"

#include <Eigen/Geometry>
#include <cmath>

#include "server/mesh/nearest.h"
#include "server/mesh/topology.h"
#include "server/physiology/diaphragm_border.h"

namespace phrenic::physiology {
namespace {

Eigen::Vector3d TurnedArea(const Eigen::Matrix3d& x) { return (x.col(1) - x.col(0)).cross(x.col(2) - x.col(0)) / 2; }

}  // namespace

Mediastinum::Mediastinum(const Mesh& sheet, const Mesh& wall, const Points& boundary, const std::vector<bool>& touches)
    : sheet_{sheet.vertices, {}, -1},
      wall_{wall.vertices, {}, SignedVolume(wall.vertices, wall.triangles) < 0 ? -1.0 : 1.0} {
  const NearestSearch lungs(boundary);
  const DiaphragmBorder border(sheet);
  const auto add = [&](const Mesh& surface, bool above_border, Faces& faces) {
    for (const Eigen::Vector3i corners : surface.triangles.colwise()) {
      const Eigen::Vector3d middle = surface.vertices(Eigen::all, corners).rowwise().mean();
      if (above_border && (!border.exists() || !border.IsBelow(middle))) continue;
      const int nearest = lungs.Nearest(middle).vertex;
      if (nearest < 0 || !touches[static_cast<size_t>(nearest)]) continue;
      faces.of_side[middle.x() < 0 ? 0 : 1].push_back(corners);
    }
  };
  add(sheet, false, sheet_);
  add(wall, true, wall_);
  bottom_ = HeightOfSheet(sheet.vertices);
  top_ = wall.vertices.row(2).maxCoeff();
}

double Mediastinum::HeightOfSheet(const ConstPoints& sheet) const {
  double area = 0, moment = 0;
  for (const std::vector<Eigen::Vector3i>& side : sheet_.of_side) {
    for (const Eigen::Vector3i& corners : side) {
      const double across = std::abs(TurnedArea(sheet_.rest(Eigen::all, corners)).z());
      area += across;
      moment += across * sheet(2, corners).mean();
    }
  }
  return area > 0 ? moment / area : 0;
}

MediastinalMotion Mediastinum::Stretched(const ConstPoints& sheet, double narrowing) const {
  return {narrowing, bottom_ - HeightOfSheet(sheet), bottom_, top_};
}

std::array<double, 2> Mediastinum::SweptBy(const Faces& faces, const ConstPoints& now) {
  std::array<double, 2> swept = {};
  for (size_t side = 0; side < swept.size(); ++side) {
    for (const Eigen::Vector3i& corners : faces.of_side[side]) {
      const Eigen::Matrix3d before = faces.rest(Eigen::all, corners), after = now(Eigen::all, corners);
      swept[side] += faces.outwards * TurnedArea((before + after) / 2).dot((after - before).rowwise().mean());
    }
  }
  return swept;
}

std::array<double, 2> Mediastinum::Swept(const ConstPoints& sheet, const ConstPoints& wall) const {
  const std::array<double, 2> by_sheet = SweptBy(sheet_, sheet), by_wall = SweptBy(wall_, wall);
  return {by_sheet[0] + by_wall[0], by_sheet[1] + by_wall[1]};
}

}  // namespace phrenic::physiology
