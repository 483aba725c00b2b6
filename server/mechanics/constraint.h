// The family of constraints: conditions on positions that hold at the end of every step.
#ifndef PHRENIC_SERVER_MECHANICS_CONSTRAINT_H_
#define PHRENIC_SERVER_MECHANICS_CONSTRAINT_H_

#include <span>
#include <string>

#include "server/mechanics/eval_context.h"
#include "server/mechanics/parallel/vertex_range.h"

namespace phrenic {

// Immutable; any number of threads may call.
class Constraint {
 public:
  virtual ~Constraint() = default;
  const std::string& name() const { return name_; }
  // Moves the positions of `state` onto the constraint, and its velocities by the same over `dt`. `before` are the
  // positions at the start of the step, `dt` its length [s].
  virtual void Project(const v1::Parameters& parameters, const ConstPoints& before, double dt, State& state) const = 0;
  // A constraint of which a part holds once it holds for each block of vertices (kVertexBlock) by itself says so. What
  // Project does, ProjectIn does to a block, and writes and reads no others' places; of where they were at the start of
  // the step it knows what Remember has put into `start`, which has room for 3 kVertexBlock numbers and is aligned for
  // vectors; it returns a bound on the way by which any coordinate has moved [m], and each velocity by the same over
  // dt. Several threads may ask at once, for different blocks. ProjectAcross does what is left, after all of them; it
  // reads `before` of the vertices `across` and moves no others. Both together give Project's bits.
  virtual bool by_range() const { return false; }
  // Whether there is anything to do in a block; the two that follow are not called for others.
  virtual bool ActsIn(const VertexRange& /*block*/, const v1::Parameters&) const { return false; }
  virtual void Remember(const VertexRange& /*block*/, const ConstPoints& /*x*/, double* /*start*/) const {}
  virtual double ProjectIn(const VertexRange& /*block*/, const double* /*start*/, double /*dt*/, Points& /*x*/,
                           Points& /*v*/) const {
    return 0;
  }
  virtual std::span<const int> across() const { return {}; }
  virtual void ProjectAcross(const v1::Parameters&, const ConstPoints& /*before*/, double /*dt*/, State&) const {}
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
