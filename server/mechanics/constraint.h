// The family of constraints: conditions on positions that hold at the end of every step.
#ifndef PHRENIC_SERVER_MECHANICS_CONSTRAINT_H_
#define PHRENIC_SERVER_MECHANICS_CONSTRAINT_H_

#include <string>

#include "server/mechanics/instant.h"
#include "server/mechanics/vertex_range.h"

namespace phrenic {

// Immutable; any number of threads may call.
class Constraint {
 public:
  virtual ~Constraint() = default;
  const std::string& name() const { return name_; }
  // Moves the positions of `state` onto the constraint, and its velocities by the same over `dt`. `before` are the
  // positions at the start of the step, `dt` its length [s].
  virtual void Project(const v1::Parameters& parameters, const ConstPoints& before, double dt, State& state) const = 0;
  // A constraint that holds for all vertices once it holds for each block of them (kVertexBlock) by itself says so:
  // what Project does, this does to the blocks of a range, with the same bits, and writes and reads at x, v and
  // `before` no others' places; several threads may ask at once, for different ranges.
  virtual bool by_range() const { return false; }
  virtual void ProjectIn(const VertexRange&, const v1::Parameters&, const ConstPoints& /*before*/, double /*dt*/,
                         Points& /*x*/, Points& /*v*/) const {}
  // Takes from the velocities what would lead off the constraint (the second half of RATTLE). Positions lie on it.
  virtual void ProjectVelocities(const v1::Parameters&, State&) const {}
  // Whether an equation that always holds describes it, as ProjectVelocities keeps it: not for what jerks.
  virtual bool smooth() const { return true; }
  // Largest violation [m].
  virtual double Residual(const State& state) const = 0;

 protected:
  explicit Constraint(std::string name) : name_(std::move(name)) {}

 private:
  std::string name_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_CONSTRAINT_H_
