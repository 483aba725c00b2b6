// The domes of a diaphragm along fixed vertical lines, as M-mode ultrasound sees them.
#ifndef PHRENIC_SERVER_PHYSIOLOGY_COLUMNS_H_
#define PHRENIC_SERVER_PHYSIOLOGY_COLUMNS_H_

#include <array>
#include <vector>

#include "phrenic/v1/scene.pb.h"
#include "server/mesh/mesh.h"

namespace phrenic::physiology {

// Returns the height at which a vertical line through (x, y) leaves a surface, coming from below [m]; kNone if it
// misses it. `vertices` is 3 x n [m].
double TopOfColumn(const ConstPoints& vertices, const Triangles& triangles, double x, double y);

// Four columns that stay where they are in space: at the apex of each dome at rest (its highest vertex more than 35 mm
// from the midline), and 40 mm behind it. Axes: +x left, +y posterior, +z cranial. Immutable, thread-safe.
class Columns {
 public:
  enum Column { kRightApex, kRightBack, kLeftApex, kLeftBack };
  static constexpr size_t kCount = 4;

  // Keeps a reference to the mesh at rest.
  explicit Columns(const Mesh& rest);

  // Returns the height of the sheet in each column [m]; kNone where the column misses it.
  std::array<double, kCount> Heights(const ConstPoints& sheet) const;
  // Mean descent of the upper face of a side between two moments, weighted by its projected area at rest [m].
  double MeanDescent(const ConstPoints& from, const ConstPoints& to, v1::Side side) const;
  // Mean descent of the posterior half of the upper face over that of the anterior half [1].
  double BackOverFront(const ConstPoints& from, const ConstPoints& to) const;
  // Depth of a hollow in a dome [m]: below the straight line between two points of the dome, in six vertical sections
  // of 90 mm through the column at its apex, of which the one with the least depth counts. A trough is no hollow.
  double Hollow(const ConstPoints& sheet, v1::Side side) const;
  // Volume between two positions of the upper face [m^3].
  double Swept(const ConstPoints& from, const ConstPoints& to) const;

  // Where a column is [m].
  Eigen::Vector2d At(Column column) const { return at_[column]; }

 private:
  template <typename Include>
  double MeanOver(const ConstPoints& from, const ConstPoints& to, const Include& include) const;

  const Mesh& rest_;
  std::array<Eigen::Vector2d, kCount> at_;
  std::vector<int> upper_;  // triangles that face up at rest
};

}  // namespace phrenic::physiology

#endif  // PHRENIC_SERVER_PHYSIOLOGY_COLUMNS_H_
