// Outlines of a bone as a camera sees them, and how far those of two bones are apart.
#ifndef PHRENIC_TESTS_ANATOMY_SILHOUETTE_H_
#define PHRENIC_TESTS_ANATOMY_SILHOUETTE_H_

#include <Eigen/Geometry>
#include <array>

#include "server/mesh/mesh.h"

namespace phrenic::anatomy {

enum class View { kFront, kBack, kLeft, kRight, kAbove, kBelow };
inline constexpr std::array<View, 6> kViews = {View::kFront, View::kBack,  View::kLeft,
                                               View::kRight, View::kAbove, View::kBelow};

// Returns the outline of a surface [m], holes included, on the plane through `centre` that faces the camera: points
// 0.5 mm apart, z = 0. The camera is half a metre from the centre and looks at it along an axis of the frame (LPS).
Points Outline(const Mesh& mesh, View view, const Eigen::Vector3d& centre);

// Returns the mean distance [m] of each outline's points from the other outline, the mean of both directions.
double MeanDistance(const Points& a, const Points& b);

// Returns the similarity (turn, shift, one scale) that moves `mesh` onto `target`: iterated closest points (Besl and
// McKay, IEEE Trans Pattern Anal Mach Intell 1992;14:239) in both directions with the least squares of Umeyama (the
// same, 1991;13:376), from equal centroids and sizes. Requires: both are turned alike to within some 20 degrees.
Eigen::Affine3d Registered(const Mesh& mesh, const Mesh& target);

}  // namespace phrenic::anatomy

#endif  // PHRENIC_TESTS_ANATOMY_SILHOUETTE_H_
