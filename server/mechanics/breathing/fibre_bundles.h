// Bundles of muscle fibres: strips of triangles that follow the fibres down to the border where they begin.
// Force-velocity acts on the mean rate of a bundle, not on that of a triangle: a fibre's force is the same over its
// length.
#ifndef PHRENIC_SERVER_MECHANICS_BREATHING_FIBRE_BUNDLES_H_
#define PHRENIC_SERVER_MECHANICS_BREATHING_FIBRE_BUNDLES_H_

#include <Eigen/Core>
#include <array>
#include <vector>

#include "server/mesh/mesh.h"

namespace phrenic {

// The bundles of the right side (x < 0 at rest), then those of the left; next to each other as on the border.
struct FibreBundles {
  static constexpr int kPerSide = 16;
  static constexpr int kCount = 2 * kPerSide;
  using Values = std::array<double, kCount>;

  std::vector<int> of_triangle;  // -1 if it is not muscle
  Values area{};                 // at rest [m^2]

  static bool OnRight(int bundle) { return bundle < kPerSide; }
  // Replaces each value by a mean, by area, with those of the bundles beside it, three times over: neighbouring fibres
  // pull alike.
  void Smooth(Values& values) const;
};

// Divides the triangles that are `muscle` into bundles of about equal area on each side, by where a way down the
// gradient of `height` (one per vertex: the harmonic function that fibres follow) ends on the mesh's border. A closed
// surface has one bundle a side.
FibreBundles MakeFibreBundles(const Mesh& mesh, const Eigen::VectorXd& height, const std::vector<bool>& muscle);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_BREATHING_FIBRE_BUNDLES_H_
