// A pressure over that outside on a surface: f_i = p a_i [N], a_i the vertex' area vector as it is now (chamber.h), so
// that the push follows the normals and moves nothing as a whole where the surface is closed.
//   p = pressure + breath_pressure breath_force signal(t) - (V - V0)/C [Pa]
// with the compliance C [m^3/Pa] where it is given: a gas of volume V at absolute pressure P, kept warm, has C = V/P
// about there (Boyle). E = -(pressure + breath part) V + (V - V0)^2/(2 C). K = a a^T/C; what follows from the normals'
// turning is indefinite and left out, so that implicit steps take more Newton steps where p is high.
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_PRESSURE_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_PRESSURE_H_

#include "server/mechanics/breathing/chamber.h"

namespace phrenic {

class Pressure final : public Force {
 public:
  // Null where no pressure can ever act.
  static absl::StatusOr<std::unique_ptr<Force>> Make(const v1::Pressure& scene, const std::string& name,
                                                     std::string_view path, ModelBuilder& builder);

  void AddForce(const EvalContext& at, MutablePoints f) const override;
  void AddStiffness(const EvalContext& at, StiffnessSink& sink) const override;
  void AddLatentStiffness(const EvalContext& at, StiffnessSink& sink) const override;
  double Energy(const EvalContext& at) const override;
  bool conservative() const override { return conserves_; }
  // Pressure and volume.
  std::span<const Output> outputs() const override;
  double Read(size_t output, const EvalContext& at) const override;

 private:
  explicit Pressure(std::string name) : Force(std::move(name)) {}
  double Given(const EvalContext& at) const;  // what does not answer to the volume [Pa]
  double PressureAt(const EvalContext& at) const;

  Chamber chamber_;
  double constant_ = 0, breath_ = 0;  // [Pa]
  double stiffness_ = 0;              // 1/C [Pa/m^3]; 0 where it does not answer
  double rest_volume_ = 0;            // [m^3]
  bool conserves_ = false;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_PRESSURE_H_
