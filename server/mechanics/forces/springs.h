// Linear springs on the edges of meshes (thesis equation 2.1):
//   f_a = k (l - l0) d, f_b = -f_a  [N],  E = k (l - l0)^2 / 2  [J],
// d the unit vector from a to b, l the length and l0 the rest length [m]. The stiffness k [N/m] is given, or computed
// from Young's modulus E [Pa] and thickness h [m] of a tissue: k = E h sum over the edge's triangles of
// 3 area / (sum of the triangle's squared edge lengths), which gives each triangle the correct mean stiffness. The live
// parameter elasticity scales k. A spring of length 0 has no direction and exerts no force. With `balanced_at_rest` the
// constant load -f(rest) is added, so that the rest mesh is in equilibrium.
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_SPRINGS_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_SPRINGS_H_

#include <vector>

#include "server/mechanics/forces/spring_rows.h"
#include "server/mechanics/model_builder.h"

namespace phrenic {

class Springs final : public Force {
 public:
  // Returns null, and reports it, if no edge lies in the region.
  static absl::StatusOr<std::unique_ptr<Force>> Make(const v1::Springs& scene, const std::string& name,
                                                     std::string_view path, ModelBuilder& builder);

  Springs(std::string name, std::vector<Spring> springs, Precision precision = Precision::kDouble);

  const std::vector<Spring>& springs() const { return springs_; }
  // The precision that the scene sets, in which a step evaluates all springs together (step/spring_batch.h).
  Precision precision() const { return precision_; }
  bool balanced() const { return rest_load_.cols() > 0; }

  // The reference implementation, in double precision.
  void AddForce(const EvalContext& at, MutablePoints f) const override;
  void AddStiffness(const EvalContext& at, StiffnessSink& sink) const override;
  double Energy(const EvalContext& at) const override;
  bool conservative() const override { return true; }

 private:
  // Adds the constant load that balances the springs at rest.
  void Balance(const Points& rest);

  std::vector<Spring> springs_;
  Precision precision_;
  Points rest_load_;  // 3 x n [N] at elasticity 1; no columns if not balanced at rest
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_SPRINGS_H_
