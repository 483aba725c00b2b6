// The pressures on a diaphragm: of the pleural spaces and lungs above, right and left, and of the abdomen below.
//
// Volumes are changes from rest [m^3]. A side h of the thorax has v_h = W_h(k) - (S_h - S_h0) +- s: W_h the volume
// inside the wall (motions/insertion.h), S_h the cones from the wall's apex over the side's triangles, and s the volume
// that the mediastinum has moved from the left side to the right, a coordinate. Gas and tissue are incompressible, so
// that v_h' is the flow into the lung. With r_h = r/2 the room of one lung
//   p_pleural,h = o_h [(p_0 - ln(r_h/(r_h - v_h + u_h))/e)/c - 2 R_p,h v_h' - R_c (o_right v_right' + o_left v_left')
//                      + p_airway - b (o_right v_right + o_left v_left - v_closed)]  [Pa],
// R_p the peripheral resistance of both lungs side by side, R_c = R - R_p that of the common airway, and by the live
// parameters c the lung_compliance, u_h the pleural_fluid and o_h = 1 - pneumothorax of the side; airway_resistance
// multiplies R. With airway_closed, or the glottis closed (breath_signal.h), the gas that the lungs had when it closed,
// v_closed, is compressed by Boyle's law: b is the atmospheric pressure over their volume, 0 while it is open, and R_c
// is 0 then. Below half of trapped_air the airways of a lung close in expiration: R_p,h grows a thousandfold. p_airway
// is airway_pressure, plus ventilator_pressure times the signal; 0 when closed. Of the abdomen, with v = S_0 - S the
// volume that the diaphragm displaces,
//   p_abdomen = p_0 + p_di + v/(C c_a) (1 + (v/V)^2) + R_a v' + p_load + P_e a_e + w . (x - x_0),
// c_a the abdominal_compliance, p_load the abdominal_load, a_e the activation of the expiratory muscles and w the
// gradient by the weight of its contents, whose direction is that of the posture. The forces are those of virtual work:
//   f_i = sum_h (p_abdomen - p_pleural,h) dS_h/dx_i,  Q_k = sum_h p_pleural,h dW_h/dk, also for parts of the cage,
//   Q_s = p_pleural,right - p_pleural,left - s/C_m - c M_m s'.
// Inside the sheet dS_h/dx_i is the area vector of the side's triangles; where the sides meet the cones' common face
// carries no force. The resistances are implicit: -df/dv = sum of R g g^T.
// Sources: exponential recoil after Salazar and Knowles (J Appl Physiol 1964;19:97); common and peripheral resistance
// and mediastinum as in Whitelaw's membrane in a chest of two sides; abdomen of incompressible contents after Mead and
// Loring (J Appl Physiol 1982;53:756).
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_THORAX_PRESSURES_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_THORAX_PRESSURES_H_

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "server/mechanics/breathing/sheet_kernel.h"
#include "server/mechanics/model_builder.h"
#include "server/mechanics/motions/insertion.h"

namespace phrenic {

class ThoraxPressures final : public Force {
 public:
  // INVALID_ARGUMENT if no insertion of the body names the wall.
  static absl::StatusOr<std::unique_ptr<Force>> Make(const v1::ThoraxPressures& scene, const std::string& name,
                                                     std::string_view path, ModelBuilder& builder);

  void AddForce(const EvalContext& at, MutablePoints f) const override;
  void AddStiffness(const EvalContext& at, StiffnessSink& sink) const override;
  bool has_shared_damping() const override { return true; }
  void AddSharedDamping(const EvalContext& at, OuterProducts& shared) const override;
  // Notes the volume of the lungs when their airway closes; the expiratory muscles follow their drive within 0.1 s.
  void AdvanceScalars(const EvalContext& end, std::int64_t tick, double dt, ScalarState& scalars) const override;
  void SetScalarRates(const EvalContext& at, Eigen::VectorXd& rates) const override;
  bool advances_scalars() const override { return true; }
  double Energy(const EvalContext& at) const override;
  // Volume of both lungs, flow into them; pleural pressure, right and left; abdominal, transdiaphragmatic and alveolar
  // pressure; volume displaced by the abdominal wall; growth from rest of the space that the lung and the fluid of each
  // side fill.
  std::span<const Output> outputs() const override;
  double Read(size_t output, const EvalContext& at) const override;

 private:
  static constexpr size_t kRight = 0, kLeft = 1;
  // Volumes, flows and pressures at one moment.
  struct Sides {
    std::array<double, 2> volume = {}, flow = {}, pleural = {};  // [m^3], [m^3/s], [Pa]
    double displaced = 0, displaced_rate = 0, abdominal = 0;     // [m^3], [m^3/s], [Pa]
    CagePosition cage;
    // 1 minus the pneumothorax; and the resistances R_p,h of each lung and R_c of both [Pa s/m^3].
    std::array<double, 2> open = {1, 1}, peripheral = {};
    double common = 0;
  };
  // The derivatives of the cones by the sheet's vertices [m^2]: a vertex is of one side, or of both on the midline.
  struct Slopes {
    Points sum;                        // dS/dx, 3 x the sheet's vertices
    Points left;                       // dS_left/dx of the midline's vertices
    Points push;                       // force of the weight [N], 3 x the sheet's vertices
    Eigen::VectorXd areas;             // of SetAreas
    std::array<double, 2> cones = {};  // S_h [m^3]
    // What they were made of: they are made again if that changes.
    const ThoraxPressures* of = nullptr;
    Points x;
    LinearField weight;
  };
  struct MidlineVertex {
    int vertex;                      // of the sheet
    std::vector<std::int32_t> left;  // its triangles on the left, as in SheetLayout::around
  };
  ThoraxPressures(std::string name, const v1::ThoraxPressures& scene, std::shared_ptr<const CageWall> wall)
      : Force(std::move(name)), scene_(scene), wall_(std::move(wall)) {}
  void AddSheet(const BodyModel& body, const Model& model);
  void AddVertices(const std::vector<std::array<std::vector<std::int32_t>, 2>>& around);
  double RecoilEnergy(double volume) const;  // [J]
  double EnergyOfWeight(const EvalContext& at) const;
  double EnergyOfGas(const EvalContext& at, const Sides& now) const;
  LinearField Weight(const v1::Parameters& parameters) const;
  // Returns the slopes and cones at a moment, valid until the next call with the same scratch memory.
  const Slopes& SlopesAt(const EvalContext& at) const;
  void SetSlopes(const ConstPoints& x, const LinearField& weight, Slopes& slopes) const;
  void AddConeFaces(const ConstPoints& x, const LinearField& weight, Slopes& slopes) const;
  // Returns dS_h/dt of each side [m^3/s].
  std::array<double, 2> Swept(const ConstPoints& v, const Slopes& slopes) const;
  // Adds right dS_right/dx + left dS_left/dx to g, 3 x simulated vertices.
  void AddSlopes(double right, double left, const Slopes& slopes, MutablePoints g) const;
  // Sets g to that.
  void SetSlopesAlone(double right, double left, const Slopes& slopes, Points& g) const;
  // Adds what the midline's vertices have on the left.
  void AddMidline(double right, double left, const Slopes& slopes, MutablePoints g) const;
  Sides SidesAt(const EvalContext& at, const Slopes& slopes) const;
  void SetResistances(const EvalContext& at, Sides& now) const;
  double AirwayPressure(const EvalContext& at, const Sides& now) const;
  // The pressure of the gas behind a closed airway, and its elastance [Pa/m^3]; 0 if it is open.
  double GasPressure(const EvalContext& at, const Sides& now) const;
  double GasElastance(const EvalContext& at) const;
  // The part of the abdominal pressure that does not depend on its volume.
  double AbdominalLoad(const EvalContext& at) const;
  double Recoil(double volume) const;       // of one lung [Pa]
  double RecoilSlope(double volume) const;  // [Pa/m^3]
  double AbdominalPressure(double displaced) const;
  double AbdominalSlope(double displaced) const;
  // The change of the volume of the lungs that the airway leads to [m^3].
  static double Volume(const Sides& now) {
    return now.open[kRight] * now.volume[kRight] + now.open[kLeft] * now.volume[kLeft];
  }
  // The flow at the mouth [m^3/s].
  static double Flow(const Sides& now) {
    return now.open[kRight] * now.flow[kRight] + now.open[kLeft] * now.flow[kLeft];
  }
  const CageFunction& WallVolume(size_t side) const {
    return side == kRight ? wall_->volumes.right : wall_->volumes.left;
  }
  // Adds a generalised force right dW_right/dk + left dW_left/dk to the coordinates of the cage.
  void AddToCage(double right, double left, const CagePosition& k, const EvalContext& at, MutablePoints f) const;
  // Sets g to right dv_right/d(all) + left dv_left/d(all), of vertices and coordinates.
  void SetVolumeSlopes(double right, double left, const Slopes& slopes, const CagePosition& k, const EvalContext& at,
                       Points& g) const;

  const v1::ThoraxPressures scene_;
  const std::shared_ptr<const CageWall> wall_;
  Coordinate shift_;  // of the mediastinum, to the left [m^3]
  double shift_damping_ = 0;
  int expiration_ = 0;    // in State::scalars: activation of the expiratory muscles
  int first_scalar_ = 0;  // in State::scalars: 1 if the airway is closed, and the volume change at which it closed
  SheetLayout sheet_;
  // Of each coordinate of the sheet: 1 if its vertex is left of the midline, 0 if right or on it.
  std::vector<double> on_left_;
  std::vector<MidlineVertex> midline_;
  std::array<double, 2> rest_cones_ = {};             // S_h0 [m^3]
  Eigen::Vector3d centre_ = Eigen::Vector3d::Zero();  // where the weight's pressure is 0 [m]
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_THORAX_PRESSURES_H_
