#include "server/mechanics/lungs/lung_field.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "server/mesh/line_crossings.h"

namespace phrenic {
namespace {

// Sets the values at a point of the grid.
void SetPoint(const LungMotion& lung, std::uint8_t number, Eigen::Index index, LungField& field) {
  const Eigen::Vector3d point = field.PointAt(index);
  field.displacement.col(index) = lung.tissue.DisplacementAt(lung.nodes, point);
  field.ventilation[index] = lung.tissue.GradientAt(lung.nodes, point).trace();
  field.lung[index] = number;
}

void AddLung(const LungMotion& lung, std::uint8_t number, LungField& field) {
  const Mesh& surface = lung.tissue.surface();
  const Points in_grid = (surface.vertices.colwise() - field.origin) / field.spacing;
  const auto crossings = LineCrossings(in_grid, surface.triangles, field.size.head<2>());
  for (size_t line = 0; line < crossings.size(); ++line) {
    const std::vector<double>& along = crossings[line];
    for (size_t c = 0; c + 1 < along.size(); c += 2) {
      const int last = std::min(field.size.z() - 1, static_cast<int>(std::floor(along[c + 1])));
      for (int k = std::max(0, static_cast<int>(std::ceil(along[c]))); k <= last; ++k) {
        SetPoint(lung, number, static_cast<Eigen::Index>(line + k * crossings.size()), field);
      }
    }
  }
}

}  // namespace

Eigen::Vector3d LungField::PointAt(Eigen::Index index) const {
  const Eigen::Index layer = static_cast<Eigen::Index>(size.x()) * size.y();
  const Eigen::Index i = index % size.x(), j = index % layer / size.x(), k = index / layer;
  return origin + spacing * Eigen::Vector3d(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k));
}

absl::StatusOr<LungField> SampleLungs(std::span<const LungMotion> lungs, double spacing) {
  if (lungs.empty()) return absl::InvalidArgumentError("the scene has no lungs: there is no field to sample");
  Eigen::AlignedBox3d box;
  for (const LungMotion& lung : lungs) box.extend(lung.tissue.box());
  const Eigen::Vector3d steps = (box.sizes() / spacing).array().ceil() + 3;
  if (!(steps.prod() <= kMostFieldPoints)) {
    return absl::InvalidArgumentError(
        absl::StrCat("a field of lungs has up to ", kMostFieldPoints, " points: make the spacing larger"));
  }
  LungField field;
  field.size = steps.cast<int>();
  field.origin = box.min().array() - spacing;
  field.spacing = spacing;
  const Eigen::Index count = field.size.cast<Eigen::Index>().prod();
  field.displacement = Points::Zero(3, count);
  field.ventilation = Eigen::VectorXd::Zero(count);
  field.lung.assign(static_cast<size_t>(count), 0);
  for (size_t i = 0; i < lungs.size(); ++i) AddLung(lungs[i], static_cast<std::uint8_t>(i + 1), field);
  return field;
}

}  // namespace phrenic
