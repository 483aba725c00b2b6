// Lungs that fill a thorax: one compartment of constant compliance C [m^3/Pa] and airway resistance R [Pa s/m^3] (the
// equation of motion of Otis, Fenn and Rahn, J Appl Physiol 1950;2:592), against the mouth's pressure:
//   p_alveolar = -R V',  p_pleural = p_alveolar + p_rest - (V - V_rest)/C  [Pa].
// Assumed: gas and pleural fluid keep their volume, so that the lungs' volume changes by that of the thorax, and V' is
// the flow through the airway; at 1 kPa a lung of 2.5 litres gives way by 25 ml. So all is a function of the state.
// V comes from `floor` and `walls` (chamber.h); on what of them is deformable the pressure's change since rest acts,
//   f_i = (p_pleural - p_rest) a_i [N],
// for what balances p_rest at rest (abdomen, chest wall) is not part of this force. E = (V - V_rest)^2/(2 C), which the
// resistance spends; K = a a^T/C without what follows from the normals' turning; -df/dv = R a a^T.
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_LUNGS_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_LUNGS_H_

#include "server/mechanics/breathing/chamber.h"

namespace phrenic {

class Lungs final : public Force {
 public:
  static absl::StatusOr<std::unique_ptr<Force>> Make(const v1::Lungs& scene, const std::string& name,
                                                     std::string_view path, ModelBuilder& builder);

  void AddForce(const EvalContext& at, MutablePoints f) const override;
  bool acts_on_vertices() const override { return pushes_; }
  bool has_shared_damping() const override { return pushes_ && resistance_ > 0; }
  void AddStiffness(const EvalContext& at, StiffnessSink& sink) const override;
  void AddSharedDamping(const EvalContext& at, OuterProducts& shared) const override;
  double Energy(const EvalContext& at) const override;
  // Volume, flow (inwards positive), alveolar and pleural pressure.
  std::span<const Output> outputs() const override;
  double Read(size_t output, const EvalContext& at) const override;

 private:
  explicit Lungs(std::string name) : Force(std::move(name)) {}
  double Change(double volume) const { return volume - chamber_.rest_volume(); }                  // [m^3]
  double AlveolarPressure(const ChamberReading& read) const { return -resistance_ * read.flow; }  // [Pa]
  double PressureChange(const ChamberReading& read) const {
    return AlveolarPressure(read) - Change(read.volume) / compliance_;
  }

  Chamber chamber_;
  bool pushes_ = false;
  double compliance_ = 1, resistance_ = 0;
  double rest_pressure_ = 0, rest_volume_ = 0;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_LUNGS_H_
