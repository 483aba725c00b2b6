// Whether a run has more kinetic energy than there can be.
#ifndef PHRENIC_SERVER_STUDY_ENERGY_BALANCE_H_
#define PHRENIC_SERVER_STUDY_ENERGY_BALANCE_H_

#include <vector>

#include "server/study/context.h"

namespace phrenic::study {

// Kinetic energy comes from three sources: that of the start, what each force with a potential V releases, and the work
// of the others: T(t) <= T(0) + sum max(V(0) - V) + sum max(0, F dx). Friction and steps that lose energy only lower T.
// The work of driven vertices is not counted. Not thread-safe.
class EnergyBalance {
 public:
  explicit EnergyBalance(const Subject& subject) : subject_(subject) {}
  // The states of a run in their order, the start first.
  void Add(const State& state);
  // Largest kinetic energy over the three sources; 0 where nothing ever moved.
  double ratio() const;

 private:
  void AddReleased(const EvalContext& at);
  void AddWork(const EvalContext& at, const State& state);

  const Subject& subject_;
  bool started_ = false;
  double kinetic_at_start_ = 0, largest_ = 0, done_ = 0;  // [J]
  std::vector<double> potential_at_start_, released_;     // of each force [J]
  Points force_, last_force_, last_x_;
};

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_ENERGY_BALANCE_H_
