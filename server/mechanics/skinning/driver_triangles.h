// The triangles of deformable bodies to which skins bind.
#ifndef PHRENIC_SERVER_MECHANICS_SKINNING_DRIVER_TRIANGLES_H_
#define PHRENIC_SERVER_MECHANICS_SKINNING_DRIVER_TRIANGLES_H_

#include <string_view>
#include <vector>

#include "server/mechanics/model_builder.h"

namespace phrenic {

// Returns the triangles with an area of all bodies, as simulated vertices. INVALID_ARGUMENT if one of the bodies is not
// deformable or has none.
absl::StatusOr<Triangles> DriverTriangles(const ModelBuilder& builder, const std::vector<int>& bodies,
                                          std::string_view path);

// Returns the barycentric weights of a point's projection onto the plane of triangle `t` of `x`, and its height above
// it [m]. Requires: the triangle has an area.
TriangleBinding BindToPlane(const ConstPoints& x, const Eigen::Vector3i& t, const Eigen::Vector3d& point);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_SKINNING_DRIVER_TRIANGLES_H_
