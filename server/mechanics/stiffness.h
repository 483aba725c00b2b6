// How forces hand over their stiffness K = -df/dx [N/m], in 3 x 3 blocks.
#ifndef PHRENIC_SERVER_MECHANICS_STIFFNESS_H_
#define PHRENIC_SERVER_MECHANICS_STIFFNESS_H_

#include <Eigen/Core>

#include "server/mesh/mesh.h"

namespace phrenic {

// Receives the stiffness of one force after another. What a force adds is symmetric and positive semi-definite: a
// compressed spring's negative transverse term, and the like, is left out.
class StiffnessSink {
 public:
  virtual ~StiffnessSink() = default;
  // K_ij += block, i and j simulated vertices.
  virtual void Add(int i, int j, const Eigen::Matrix3d& block) = 0;
  // K += scale g g^T [N/m], g 3 x n: a pressure that answers to the volume below a whole surface.
  virtual void AddOuter(double scale, const Points& g) = 0;

  // What a spring between two vertices adds: the force on a changes by block (dx_b - dx_a), that on b by its opposite.
  // The block is symmetric.
  virtual void AddBetween(int a, int b, const Eigen::Matrix3d& block) {
    Add(a, a, block);
    Add(b, b, block);
    Add(a, b, -block);
    Add(b, a, -block);
  }
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_STIFFNESS_H_
