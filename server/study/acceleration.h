// The equations of motion without an integrator, as the right-hand side for an independent ODE solver.
#ifndef PHRENIC_SERVER_STUDY_ACCELERATION_H_
#define PHRENIC_SERVER_STUDY_ACCELERATION_H_

#include <vector>

#include "server/study/context.h"

namespace phrenic::study {

// Evaluates the accelerations a = M^-1 f(t, x, v, q) of the free vertices (those with finite mass that no motion
// drives), and the rates of the scalars q that forces integrate, such as activations. Scalars that change in jumps (the
// volume at which the airway was closed) are set at each state.
// With constraints, a is the constrained acceleration
//   a = dv*/dt,  v* = the velocities v + a dt of an unconstrained step, at x + v dt, projected (mass-weighted) onto the
// constraints, by a central difference of that projection. This is the index-1 form of the equations with Lagrange
// multipliers; its relative error is about 1e-9. Not thread-safe.
class Acceleration {
 public:
  // UNIMPLEMENTED if the model has a constraint without a smooth equation (limits; the thesis' projection).
  static absl::StatusOr<Acceleration> Make(const Subject& subject);

  // Indices of the free vertices. The unknowns follow this order: first x, then v, three numbers each.
  const std::vector<int>& free() const { return free_; }
  // Indices in State::scalars of those that forces integrate: the last unknowns.
  const std::vector<int>& scalars() const { return scalars_; }
  // Sets the state at `time` [s] from the unknowns `x` (displacements from rest [m]) and `v` [m/s], each 3 x free, and
  // `q` [unit], one per scalar, with driven vertices moved by their motions, and returns it. The reference is valid
  // until the next call.
  const State& SetState(double time, const ConstPoints& x, const ConstPoints& v,
                        const Eigen::Ref<const Eigen::VectorXd>& q);
  // Writes the accelerations [m/s^2] of the state that was set, 3 x free, and the rates [unit/s] of the scalars.
  void Evaluate(MutablePoints a, Eigen::Ref<Eigen::VectorXd> rates);

 private:
  explicit Acceleration(const Subject& subject);
  void FindScalars();
  void Unconstrained(MutablePoints a, Eigen::Ref<Eigen::VectorXd> rates);
  // Writes the velocities at the time offset `ahead` [s], projected onto the constraints.
  void ProjectedVelocities(double ahead, const ConstPoints& a, Points& v);

  Subject subject_;
  std::vector<int> free_, scalars_;
  Eigen::VectorXd rates_;  // of all scalars [unit/s]
  State state_, ahead_;
  Points force_, later_, earlier_;
  Scratch scratch_;
};

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_ACCELERATION_H_
