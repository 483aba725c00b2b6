// Cables: tension-only springs between vertices a and b,
//   f_a = k max(0, l - l0) d, f_b = -f_a  [N];  E = k max(0, l - l0)^2 / 2  [J],
// d the unit vector from a to b, l the length and l0 the rest length [m], k the stiffness [N/m] times the live
// parameter elasticity. A slack cable (l <= l0) has no force, energy or stiffness. Cables and struts (rigid links) form
// a tensegrity (thesis section 2.4).
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_CABLES_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_CABLES_H_

#include <vector>

#include "server/mechanics/model_builder.h"

namespace phrenic {

class Cables final : public Force {
 public:
  // Returns null, and reports it, if no edge lies in the region.
  static absl::StatusOr<std::unique_ptr<Force>> Make(const v1::Cables& scene, const std::string& name,
                                                     std::string_view path, ModelBuilder& builder);

  void AddForce(const EvalContext& at, MutablePoints f) const override;
  void AddStiffness(const EvalContext& at, StiffnessSink& sink) const override;
  void AddLatentStiffness(const EvalContext& at, StiffnessSink& sink) const override;
  double Energy(const EvalContext& at) const override;
  bool conservative() const override { return true; }

 private:
  struct Cable {
    int a, b;
    double rest_length;  // [m]
  };
  explicit Cables(std::string name) : Force(std::move(name)) {}

  std::vector<Cable> cables_;
  double stiffness_ = 0;  // [N/m]
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_CABLES_H_
