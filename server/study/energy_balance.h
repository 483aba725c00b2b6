// Checks whether a run gains energy that no source supplies.
#ifndef PHRENIC_SERVER_STUDY_ENERGY_BALANCE_H_
#define PHRENIC_SERVER_STUDY_ENERGY_BALANCE_H_

#include <vector>

#include "server/study/context.h"

namespace phrenic::study {

// Compares the kinetic energy T with its three sources: the initial T, the potential energy released by each
// conservative force, and the work of the other forces:
//   T(t) <= T(0) + sum max(V(0) - V) + sum max(0, F dx)   [J]
// Work is integrated by the trapezoidal rule. Friction and numerical dissipation only lower T. The work of driven
// vertices is not counted. Requires: the subject outlives it. Not thread-safe.
class EnergyBalance {
 public:
  explicit EnergyBalance(const Subject& subject) : subject_(subject) {}
  // Adds the next state of a run. Requires: states are added in order of time, the initial state first.
  void Add(const State& state);
  // Returns the largest kinetic energy over the sum of the sources; above 1 means spurious energy. 0 if nothing moved.
  double ratio() const;

 private:
  void AddReleased(const EvalContext& at);
  void AddWork(const EvalContext& at, const State& state);

  const Subject& subject_;
  bool started_ = false;
  double kinetic_at_start_ = 0, largest_ = 0, done_ = 0;  // [J]
  std::vector<double> potential_at_start_, released_;     // one per force [J]
  Points force_, last_force_, last_x_;
};

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_ENERGY_BALANCE_H_
