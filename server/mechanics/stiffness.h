// The interface to which forces add their stiffness K = -df/dx [N/m], in 3 x 3 blocks.
#ifndef PHRENIC_SERVER_MECHANICS_STIFFNESS_H_
#define PHRENIC_SERVER_MECHANICS_STIFFNESS_H_

#include <Eigen/Core>
#include <span>

#include "server/mechanics/spring.h"
#include "server/mesh/mesh.h"

namespace phrenic {

struct EvalContext;

// The stiffness of a spring between two vertices: the force on a changes by (axial e e^T + transverse I)(dx_b - dx_a),
// that on b by its opposite. `edge` is e = x_b - x_a [m]; axial [N/m^3] and transverse [N/m] are not negative.
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

// Sums the stiffness of one force after another. Each force's stiffness is symmetric and positive semi-definite: it
// leaves out negative terms, such as the transverse one of a compressed spring.
class StiffnessSink {
 public:
  virtual ~StiffnessSink() = default;
  // Adds `block` to K_ij, i and j simulated vertices.
  virtual void Add(int i, int j, const Eigen::Matrix3d& block) = 0;
  // Adds scale g g^T [N/m], g of 3 x n: of a pressure that depends on the volume below a surface.
  virtual void AddOuter(double scale, const Points& g) = 0;

  // Adds all springs of a force at this moment. Leaves out springs of length 0, which have no direction.
  virtual void AddSpringsAt(std::span<const Spring> springs, const EvalContext& at);
  // Adds several springs.
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
