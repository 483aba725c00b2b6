// A pressure difference across a surface: f_i = p a_i [N], a_i the current area vector of vertex i [m^2] (chamber.h).
// The force follows the normals; its resultant is zero on a closed surface.
//   p = pressure + breath_pressure breath_force signal(t) - (V - V0)/C  [Pa],
// the last term only if the compliance C [m^3/Pa] is set. An isothermal gas of volume V at absolute pressure P has
// C = V/P in linear approximation (Boyle).
//   E = -(pressure + breath part) V + (V - V0)^2/(2 C)  [J].
// K = a a^T/C. The term from the rotation of the normals is indefinite and left out; implicit integrators therefore
// need more Newton iterations at high p.
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_PRESSURE_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_PRESSURE_H_

#include "server/mechanics/breathing/chamber.h"

namespace phrenic {

class Pressure final : public Force {
 public:
  // Returns null, and reports it, if pressure and breath_pressure are 0 and there is no compliance. INVALID_ARGUMENT if
  // a body is not deformable or the surface has no triangle.
  static absl::StatusOr<std::unique_ptr<Force>> Make(const v1::Pressure& scene, const std::string& name,
                                                     std::string_view path, ModelBuilder& builder);

  void AddForce(const EvalContext& at, MutablePoints f) const override;
  void AddStiffness(const EvalContext& at, StiffnessSink& sink) const override;
  void AddLatentStiffness(const EvalContext& at, StiffnessSink& sink) const override;
  double Energy(const EvalContext& at) const override;
  bool conservative() const override { return conserves_; }
  // Pressure [Pa] and volume [m^3].
  std::span<const Output> outputs() const override;
  double Read(size_t output, const EvalContext& at) const override;

 private:
  explicit Pressure(std::string name) : Force(std::move(name)) {}
  double Given(const EvalContext& at) const;  // the part of p that does not depend on the volume [Pa]
  double PressureAt(const EvalContext& at) const;

  Chamber chamber_;
  double constant_ = 0, breath_ = 0;  // [Pa]
  double stiffness_ = 0;              // 1/C [Pa/m^3]; 0 without compliance
  double rest_volume_ = 0;            // V0 [m^3]
  bool conserves_ = false;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_PRESSURE_H_
