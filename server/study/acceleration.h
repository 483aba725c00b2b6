// The equations of motion themselves, without any integrator: what an independent solver integrates.
#ifndef PHRENIC_SERVER_STUDY_ACCELERATION_H_
#define PHRENIC_SERVER_STUDY_ACCELERATION_H_

#include <vector>

#include "server/study/context.h"

namespace phrenic::study {

// a = M^-1 f(t, x, v) of the vertices that forces move; where there are constraints, a is what keeps to them:
//   a = dv*/dt,  v* = the velocities v + a dt of an unconstrained moment, at x + v dt, projected (mass-weighted) onto
// the constraints, by a central difference of that projection. That is the index-1 form of the equations with Lagrange
// multipliers; its relative error is about 1e-9. Not thread-safe.
class Acceleration {
 public:
  // UNIMPLEMENTED for a model with a constraint that no smooth equation describes (limits; the thesis' projection).
  static absl::StatusOr<Acceleration> Make(const Subject& subject);

  // The vertices that forces move: the unknowns, in this order, x then v, three numbers each.
  const std::vector<int>& free() const { return free_; }
  // State at `time` with the unknowns `x` (displacements from rest [m]) and `v` [m/s], each 3 x free; driven vertices
  // where the motions have them.
  const State& Place(double time, const ConstPoints& x, const ConstPoints& v);
  // Acceleration [m/s^2] of the placed state, 3 x free.
  void Evaluate(MutablePoints a);

 private:
  explicit Acceleration(const Subject& subject);
  void Unconstrained(MutablePoints a);
  // The velocities a little later or earlier, on the constraints.
  void VelocitiesAhead(double ahead, const ConstPoints& a, Points& v);

  Subject subject_;
  std::vector<int> free_;
  State state_, ahead_;
  Points force_, later_, earlier_;
  Scratch scratch_;
};

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_ACCELERATION_H_
