// The recoil of a free rib cage and the muscles that raise it. On each coordinate k, the pump handle and the bucket
// handle, with V_k = dV/dk at rest, V the volume inside the wall above the insertion [m^3]:
//   Q = Q_rest - K k - c M k' + K s a (1 - l (k_pump + k_bucket)/2)  [J],  K = V_k (V_pump + V_bucket)/C  [J],
// so that at a pressure p inside both coordinates move alike and the volume by p C. Below rest K is several times
// larger; the live parameter chest_wall_compliance divides both. M is the coordinate's inertia, s the muscles' share
// and l their loss of force by shortening. Q_rest balances all other forces at rest. a is the live parameter
// intercostal_activation, times breath_force, rib_motion and the breath's signal, less expiratory_activation times the
// share of the expiratory muscles; muscle_strength scales it, and pump_handle and bucket_handle the two shares.
// The expiratory muscles of the ribs withstand a pleural pressure besides: with their activation a_e, which follows its
// drive as that of the abdominal muscles does (breathing/expiratory_muscles.h),
//   Q = -V_k P_x a_e min(1, max(0, 1 + k/k_x)),  P_x the expiratory_pressure, k_x the expiratory_range:
// short fibres pull less, and at residual volume not at all.
//   E = sum K k^2/2 - Q_rest k  [J].
// Where the sides move apart (motions/insertion.h), by t from the mean, each has half of K and of the muscles: right
// k + t - t_0 and left k - t + t_0 stand for k, with the live parameters t_0 cage_tilt, right_cage_compliance and
// left_cage_compliance, which divide K of their side additionally, and right_intercostals and left_intercostals, which
// scale a. Sternum and spine couple the sides by E = K_t (t - t_0)^2/2, K_t the `side_coupling` of the sum of both K. A
// segment of broken ribs is held by soft tissue and driven by the pleural pressure alone:
//   Q_u = Q_rest - K_u u (1 + u^2) - c M_u u',  K_u = V_u^2/(C_s flail),
// C_s the segment_compliance and flail one of the live parameters flail_right and flail_left. What is not moved is held
// at 0, a critically damped spring leads it back.
// Compliance of the relaxed chest wall without the abdomen: breathing mechanics texts; the split between pump and
// bucket as the ribs' table makes it. That the ribs' muscles bear what the abdominal ones press: in a maximal effort to
// breathe out against a shut airway pleural and abdominal pressure are alike, and the chest keeps its shape (Agostoni
// and Mead 1964, Handbook of Physiology, Respiration I; Cook, Mead and Orzalesi, J Appl Physiol 1964;19:1016); that
// they lose their force towards residual volume: Leith and Mead, J Appl Physiol 1967;23:221.
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_CHEST_WALL_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_CHEST_WALL_H_

#include <array>
#include <memory>
#include <vector>

#include "server/mechanics/model_builder.h"
#include "server/mechanics/motions/insertion.h"

namespace phrenic {

class ChestWall final : public Force {
 public:
  // INVALID_ARGUMENT if no insertion names the wall.
  static absl::StatusOr<std::unique_ptr<Force>> Make(const v1::ChestWall& scene, const std::string& name,
                                                     std::string_view path, ModelBuilder& builder);

  void AddForce(const EvalContext& at, MutablePoints f) const override;
  void AddStiffness(const EvalContext& at, StiffnessSink& sink) const override;
  double Energy(const EvalContext& at) const override;
  void AdvanceScalars(const EvalContext& end, std::int64_t tick, double dt, ScalarState& scalars) const override;
  void SetScalarRates(const EvalContext& at, Eigen::VectorXd& rates) const override;
  bool advances_scalars() const override { return expiratory_pressure_ > 0; }
  bool balances_at_rest() const override { return true; }
  absl::Status BalanceAtRest(const ConstPoints& load, const ConstPoints& normals, ModelBuilder& builder,
                             Eigen::VectorXd& pushes) override;
  // k of the pump handle and the bucket handle, and of the parts t and u, 0 where the cage lacks them [-].
  std::span<const Output> outputs() const override;
  double Read(size_t output, const EvalContext& at) const override;

 private:
  // A part of the cage that the wall has.
  struct Part {
    CagePart part = kCageSides;
    Coordinate coordinate;
    double stiffness = 0;  // K_t, or V_u^2/C_s [J]
    double damping = 0;    // c M [J s]
    double holding = 0;    // of what is held [J]
    double rest_load = 0;  // Q_rest [J]
  };
  struct Handle {
    Coordinate coordinate;
    double stiffness = 0;  // K [J]
    double share = 0;      // s
    double damping = 0;    // c M [J s]
    double slope = 0;      // V_k [m^3]
    double rest_load = 0;  // Q_rest [J]
  };
  explicit ChestWall(std::string name) : Force(std::move(name)) {}
  double Stiffness(const Handle& handle, const EvalContext& at, double k) const {
    return handle.stiffness * (k < 0 ? stiffening_below_rest_ : 1) / at.parameters.chest_wall_compliance();
  }
  // INVALID_ARGUMENT if the volume inside the wall does not grow with a segment.
  absl::Status AddParts(const v1::ChestWall& scene, std::string_view path, const ModelBuilder& builder);
  // a, of both sides or of one: `share` scales what raises the ribs.
  double Activation(const EvalContext& at, double share = 1) const;
  // The force of the ribs' expiratory muscles on a handle at k [J], and minus its derivative by k.
  double Expiratory(const Handle& handle, const EvalContext& at, double k) const;
  double ExpiratoryStiffness(const Handle& handle, const EvalContext& at, double k) const;
  // What a handle of one side has: half the stiffness, and its distance from where it rests.
  struct HalfHandle {
    double sign = 1, stiffness = 0, beyond = 0, pull = 0, press = 0;
  };
  std::array<HalfHandle, 2> Halves(const Handle& handle, double tilt, const EvalContext& at) const;
  bool SidesMove(const EvalContext& at) const { return wall_->Moves(kCageSides, at); }
  const Part* Sides() const;
  double SegmentStiffness(const Part& part, const EvalContext& at) const;
  void AddForceOfSides(const EvalContext& at, MutablePoints f) const;
  void AddForceOfParts(const EvalContext& at, MutablePoints f) const;
  double EnergyOfSides(const EvalContext& at) const;

  std::shared_ptr<const CageWall> wall_;
  std::array<Handle, 2> handles_;
  std::vector<Part> parts_;
  double stiffening_below_rest_ = 1, shortening_loss_ = 0, expiratory_share_ = 0;
  double expiratory_pressure_ = 0, expiratory_range_ = 1;  // P_x [Pa], k_x
  int expiration_ = 0;                                     // in State::scalars: a_e, if P_x is not 0
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_CHEST_WALL_H_
