// Skins that bind the two layers of a sheet of tissue, which are only seen, to its deformable middle surface
// (SKIN_MODE_SHEET).
//
// A vertex is bound to its foot point on the middle surface at rest: X = sum_i b_i X_i + H n, n the unit vertex normals
// interpolated at b. Nothing of it is tangential, so that the position at rest is reproduced, and a vertex beyond the
// border has a weight below 0. How it moves: sheet_points.h.
#ifndef PHRENIC_SERVER_MECHANICS_SKINNING_SHEET_SKIN_H_
#define PHRENIC_SERVER_MECHANICS_SKINNING_SHEET_SKIN_H_

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "server/mechanics/model_builder.h"
#include "server/mesh/triangle_tree.h"

namespace phrenic {

// Binds bodies to the triangles of some deformable bodies at rest. The builder must outlive it. Not thread-safe.
class SheetBinder {
 public:
  // INVALID_ARGUMENT if one of the bodies is not deformable or has no triangles with an area.
  static absl::StatusOr<SheetBinder> Make(const ModelBuilder& builder, const std::vector<int>& drivers,
                                          std::string_view path);

  // Returns the skin of a body, and reports its distances from the middle surface. INVALID_ARGUMENT names the first
  // vertex that is further from it than the sheet's `thickness` [m], or whose foot point is not unique because the
  // surface is bent too sharply. `path` is the scene's message.
  absl::StatusOr<Skin> Bind(int body, double thickness, const std::string& path, v1::MappingReport& report) const;

 private:
  SheetBinder(const ModelBuilder& builder, const Triangles& triangles);
  // Returns false if the search for the foot point on this triangle's plane, by `fraction` of each step of a
  // fixed-point iteration, does not converge.
  bool FindFoot(const Eigen::Vector3i& triangle, const Eigen::Vector3d& point, double fraction,
                TriangleBinding& foot) const;
  // Returns the binding with the foot point inside a triangle, or nearest to inside; no corners if there is no
  // triangle.
  TriangleBinding Foot(const Eigen::Vector3d& point) const;

  const ModelBuilder& builder_;
  std::shared_ptr<DriverSheet> sheet_;
  Points normals_;                      // of the vertices of sheet_, from first_vertex on
  std::vector<std::vector<int>> fans_;  // the triangles at each of them
  TriangleTree tree_;
  TriangleTree::Boxes boxes_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_SKINNING_SHEET_SKIN_H_
