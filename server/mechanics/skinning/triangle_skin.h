// Skins that bind a fine surface, which is only seen, to the triangles of a coarse mechanical one (thesis
// section 6.1.3).
//
// Each fine vertex is bound to the triangle nearest to it at rest, x = sum_i b_i x_i + h n: b the barycentric
// coordinates of its projection onto the triangle's plane, h its height [m], n the unit normal. The binding follows
// rigid motions of the drivers exactly, and uniform stretches exactly in the plane of the triangle; h does not stretch.
// Across an edge the position is continuous on the surface itself; at a height h it may jump by h |n_1 - n_2|.
#ifndef PHRENIC_SERVER_MECHANICS_SKINNING_TRIANGLE_SKIN_H_
#define PHRENIC_SERVER_MECHANICS_SKINNING_TRIANGLE_SKIN_H_

#include <string_view>
#include <vector>

#include "server/mechanics/model_builder.h"
#include "server/mesh/triangle_tree.h"

namespace phrenic {

// Binds bodies to the triangles of some deformable bodies at rest. The builder must outlive it. Not thread-safe.
class TriangleBinder {
 public:
  // INVALID_ARGUMENT if one of the bodies is not deformable or has no triangles with an area.
  static absl::StatusOr<TriangleBinder> Make(const ModelBuilder& builder, const std::vector<int>& drivers,
                                             std::string_view path);

  // Returns the skin of a body, and reports its distances from the triangles.
  Skin Bind(int body, v1::MappingReport& report) const;

 private:
  TriangleBinder(const ModelBuilder& builder, const Triangles& triangles);

  const ModelBuilder& builder_;
  TriangleTree tree_;
  TriangleTree::Boxes boxes_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_SKINNING_TRIANGLE_SKIN_H_
