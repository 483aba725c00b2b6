// How forces hand over their stiffness K = -df/dx [N/m], in 3 x 3 blocks.
#ifndef PHRENIC_SERVER_MECHANICS_STIFFNESS_H_
#define PHRENIC_SERVER_MECHANICS_STIFFNESS_H_

#include <Eigen/Core>
#include <span>

#include "server/mechanics/spring.h"
#include "server/mesh/mesh.h"

namespace phrenic {

struct EvalContext;

// What a spring between two vertices adds: the force on a changes by (axial e e^T + transverse I)(dx_b - dx_a), that on
// b by its opposite. `edge` is e = x_b - x_a at the instant [m]; axial [N/m^3] and transverse [N/m] are not negative.
struct SpringStiffness {
  int a = 0, b = 0;
  Eigen::Vector3d edge = Eigen::Vector3d::Zero();
  double axial = 0, transverse = 0;

  Eigen::Matrix3d Block() const {
    Eigen::Matrix3d block = edge * (axial * edge).transpose();
    block.diagonal().array() += transverse;
    return block;
  }
};

// Receives the stiffness of one force after another. What a force adds is symmetric and positive semi-definite: a
// compressed spring's negative transverse term, and the like, is left out.
class StiffnessSink {
 public:
  virtual ~StiffnessSink() = default;
  // K_ij += block, i and j simulated vertices.
  virtual void Add(int i, int j, const Eigen::Matrix3d& block) = 0;
  // K += scale g g^T [N/m], g 3 x n: a pressure that answers to the volume below a whole surface.
  virtual void AddOuter(double scale, const Points& g) = 0;

  // All springs of a force at this instant. One without length is left out: it has no direction.
  virtual void AddSpringsAt(std::span<const Spring> springs, const EvalContext& at);
  // Many springs at a time, as they are worked out.
  virtual void AddSprings(std::span<const SpringStiffness> springs) {
    for (const SpringStiffness& spring : springs) {
      const Eigen::Matrix3d block = spring.Block();
      Add(spring.a, spring.a, block);
      Add(spring.b, spring.b, block);
      Add(spring.a, spring.b, -block);
      Add(spring.b, spring.a, -block);
    }
  }
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_STIFFNESS_H_
