// Lungs that fill the thorax: one compartment of constant compliance C [m^3/Pa] and airway resistance R [Pa s/m^3] (the
// equation of motion of Otis, Fenn and Rahn, J Appl Physiol 1950;2:592). Pressures are relative to the mouth:
//   p_alveolar = -R V',  p_pleural = p_alveolar + p_rest - (V - V_rest)/C  [Pa].
// Assumption: gas and pleural fluid are incompressible, so that the volume of the lungs changes by that of the thorax
// and V' is the airway flow. (The error: at 1 kPa a lung of 2.5 litres is compressed by 25 ml.) All outputs are hence
// functions of the state. V is the volume bounded by `floor` and `walls` (chamber.h). Their deformable parts are loaded
// by the change of the pressure since rest,
//   f_i = (p_pleural - p_rest) a_i  [N],  a_i the area vector of vertex i [m^2],
// because the structures that balance p_rest at rest (abdomen, chest wall) are not part of this force.
// E = (V - V_rest)^2/(2 C) [J], dissipated by the resistance. K = a a^T/C, without the term from the rotation of the
// normals; -df/dv = R a a^T.
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_LUNGS_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_LUNGS_H_

#include "server/mechanics/breathing/chamber.h"

namespace phrenic {

class Lungs final : public Force {
 public:
  // INVALID_ARGUMENT if the scene sets neither floor nor walls, or they select no triangle.
  static absl::StatusOr<std::unique_ptr<Force>> Make(const v1::Lungs& scene, const std::string& name,
                                                     std::string_view path, ModelBuilder& builder);

  void AddForce(const EvalContext& at, MutablePoints f) const override;
  bool acts_on_vertices() const override { return pushes_; }
  bool has_shared_damping() const override { return pushes_ && resistance_ > 0; }
  void AddStiffness(const EvalContext& at, StiffnessSink& sink) const override;
  void AddSharedDamping(const EvalContext& at, OuterProducts& shared) const override;
  double Energy(const EvalContext& at) const override;
  // Volume [m^3], flow (positive inwards) [m^3/s], alveolar and pleural pressure [Pa].
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
  bool pushes_ = false;                         // part of the surface is deformable
  double compliance_ = 1, resistance_ = 0;      // C [m^3/Pa], R [Pa s/m^3]
  double rest_pressure_ = 0, rest_volume_ = 0;  // [Pa], [m^3]
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_LUNGS_H_
