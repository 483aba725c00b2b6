// The mapping of a fine surface that is only seen onto the triangles of a coarse mechanical one (thesis section 6.1.3):
// each fine vertex keeps its place in the triangle nearest to it at rest, x = sum_i b_i x_i + h n, b the barycentric
// coordinates of its foot on the triangle's plane, h its height [m], n the triangle's unit normal. Rigid motions of the
// carriers are followed exactly, even stretches exactly in the plane of the triangle; h does not stretch. Across an
// edge on the surface itself the mapping is continuous; at a height h it may jump by h |n_1 - n_2|.
#ifndef PHRENIC_SERVER_MECHANICS_SKINNING_TRIANGLE_SKIN_H_
#define PHRENIC_SERVER_MECHANICS_SKINNING_TRIANGLE_SKIN_H_

#include <string_view>
#include <vector>

#include "server/mechanics/model_builder.h"
#include "server/mesh/triangle_tree.h"

namespace phrenic {

// All triangles of some deformable bodies at rest. Keeps a reference into the builder: use it while it lasts.
class Mapping {
 public:
  // INVALID_ARGUMENT where one of the bodies is not deformable or has no triangles with an area.
  static absl::StatusOr<Mapping> Make(const ModelBuilder& builder, const std::vector<int>& carriers,
                                      std::string_view path);

  // The ride of a body on those triangles, and how well it lies on them.
  Skin Carry(int body, v1::MappingReport& report) const;

 private:
  Mapping(const ModelBuilder& builder, const Triangles& triangles);

  const ModelBuilder& builder_;
  TriangleTree tree_;
  TriangleTree::Boxes boxes_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_SKINNING_TRIANGLE_SKIN_H_
