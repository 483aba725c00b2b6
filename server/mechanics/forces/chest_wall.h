// The recoil of a free rib cage and the muscles that raise it. On each coordinate k, the pump handle and the bucket
// handle, with V_k = dV/dk at rest, V the volume inside the wall above the insertion [m^3]:
//   Q = Q_rest - K k - c M k' + K s a (1 - l (k_pump + k_bucket)/2)  [J],  K = V_k (V_pump + V_bucket)/C  [J],
// so that at a pressure p inside both coordinates move alike and the volume by p C. Below rest K is several times
// larger; the live parameter chest_wall_compliance divides both. M is the coordinate's inertia, s the muscles' share
// and l their loss of force by shortening. Q_rest balances all other forces at rest. a is the live parameter
// intercostal_activation, times breath_force, rib_motion and the breath's signal, less expiratory_activation times the
// share of the expiratory muscles; muscle_strength scales it, and pump_handle and bucket_handle the two shares.
//   E = sum K k^2/2 - Q_rest k  [J].
// Compliance of the relaxed chest wall without the abdomen: breathing mechanics texts; the split between pump and
// bucket as the ribs' table makes it.
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_CHEST_WALL_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_CHEST_WALL_H_

#include <array>
#include <memory>

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
  bool balances_at_rest() const override { return true; }
  absl::Status BalanceAtRest(const ConstPoints& load, const ConstPoints& normals, ModelBuilder& builder,
                             Eigen::VectorXd& pushes) override;
  // k of the pump handle and the bucket handle [-].
  std::span<const Output> outputs() const override;
  double Read(size_t output, const EvalContext& at) const override;

 private:
  struct Handle {
    Coordinate coordinate;
    double stiffness = 0;  // K [J]
    double share = 0;      // s
    double damping = 0;    // c M [J s]
    double rest_load = 0;  // Q_rest [J]
  };
  explicit ChestWall(std::string name) : Force(std::move(name)) {}
  double Stiffness(const Handle& handle, const EvalContext& at, double k) const {
    return handle.stiffness * (k < 0 ? stiffening_below_rest_ : 1) / at.parameters.chest_wall_compliance();
  }
  // a
  double Activation(const EvalContext& at) const;

  std::array<Handle, 2> handles_;
  double stiffening_below_rest_ = 1, shortening_loss_ = 0, expiratory_share_ = 0;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_CHEST_WALL_H_
