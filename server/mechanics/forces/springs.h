// Springs over edges (thesis equation 2.1): f_a = k (l - l0) d, d the unit vector from a to b, f_b = -f_a.
// k [N/m] is given, or follows from a tissue's Young's modulus E and thickness h: k = E h sum over the edge's triangles
// of 3 area / (sum of the triangle's edges squared), which puts the right mean stiffness into every triangle. It is
// scaled by the live parameter elasticity. A spring of length 0 has no direction and pulls with no force.
// With `balanced_at_rest` the constant load -f(rest) acts too, so that the mesh as it stands is in balance.
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_SPRINGS_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_SPRINGS_H_

#include <vector>

#include "server/mechanics/forces/spring_rows.h"
#include "server/mechanics/model_builder.h"

namespace phrenic {

class Springs final : public Force {
 public:
  // Null where no edge lies in the region.
  static absl::StatusOr<std::unique_ptr<Force>> Make(const v1::Springs& scene, const std::string& name,
                                                     std::string_view path, ModelBuilder& builder);

  Springs(std::string name, std::vector<Spring> springs, Precision precision = Precision::kDouble);

  const std::vector<Spring>& springs() const { return springs_; }
  // A step works all springs out together (spring_batch.h), in the precision that the scene asks for.
  Precision precision() const { return precision_; }
  bool balanced() const { return rest_load_.cols() > 0; }

  // As one would write it down, in double precision.
  void AddForce(const EvalContext& at, MutablePoints f) const override;
  void AddStiffness(const EvalContext& at, StiffnessSink& sink) const override;
  double Energy(const EvalContext& at) const override;
  bool conservative() const override { return true; }

 private:
  // The constant load that holds the springs at rest acts from now on.
  void Balance(const Points& rest);

  std::vector<Spring> springs_;
  Precision precision_;
  Points rest_load_;  // 3 x n [N] at elasticity 1; no columns where the rest is not balanced
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_SPRINGS_H_
