// The family of constraints. To add one: a file in constraints/, a message in constraints.proto, its case in
// compile/catalogue.cc, its line in tests/contract.
#ifndef PHRENIC_SERVER_MECHANICS_CONSTRAINT_H_
#define PHRENIC_SERVER_MECHANICS_CONSTRAINT_H_

#include <string>
#include <utility>
#include <vector>

#include "phrenic/v1/parameters.pb.h"
#include "server/mechanics/link.h"
#include "server/mechanics/scratch.h"
#include "server/mechanics/state.h"

namespace phrenic {

// A condition on positions that holds at the end of every step. Immutable and thread-safe. No call allocates once its
// scratch memory is large enough. A constraint that can be projected for some vertices at a time may be a
// BlockConstraint (block_constraint.h).
class Constraint {
 public:
  virtual ~Constraint() = default;
  const std::string& name() const { return name_; }

  // Moves the positions of `state` onto the constraint, and changes its velocities by the same displacement over `dt`.
  // `before` are the positions at the start of the step, 3 x n [m], `dt` is its length [s].
  virtual void Project(const v1::Parameters& parameters, const ConstPoints& before, double dt, const Scratch& scratch,
                       State& state) const = 0;
  // Removes from the velocities what would violate the constraint (the second half of RATTLE). Requires: positions
  // satisfy the constraint.
  virtual void ProjectVelocities(const v1::Parameters&, const Scratch&, State&) const {}
  // True if the constraint is an equation at all times, as ProjectVelocities assumes; false for inequalities and for
  // the thesis' links.
  virtual bool smooth() const { return true; }
  // Adds the links that it consists of and that have a movable end: implicit steps solve them together with the forces
  // (solve/link_equations.h). Adds nothing if it can be projected after a step only.
  virtual void ListLinks(std::vector<Link>&) const {}
  // True if a method of several steps may continue from positions `before` over `after`, 3 x n [m]: the constraint is
  // the same equation at both.
  virtual bool SameMotion(const ConstPoints& /*before*/, const ConstPoints& /*after*/) const { return smooth(); }
  // Returns the largest violation [m].
  virtual double Residual(const State& state) const = 0;
  // Returns the largest violation [m] that its projection may leave in a scene of this size [m]; more is a warning.
  virtual double tolerated(double size) const { return 1e-6 * size; }

 protected:
  explicit Constraint(std::string name) : name_(std::move(name)) {}

 private:
  std::string name_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_CONSTRAINT_H_
