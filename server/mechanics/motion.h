// The family of motions. To add one: a file in motions/, a message in scene.proto, its case in compile/catalogue.cc,
// its line in tests/contract.
#ifndef PHRENIC_SERVER_MECHANICS_MOTION_H_
#define PHRENIC_SERVER_MECHANICS_MOTION_H_

#include <string>
#include <utility>

#include "server/mechanics/eval_context.h"

namespace phrenic {

// A prescribed motion of bones or of single vertices: a function of time, breath and parameters. Motions run in the
// scene's order, so that one may follow another. Immutable and thread-safe.
class Motion {
 public:
  virtual ~Motion() = default;
  const std::string& name() const { return name_; }
  // Sets what the motion drives to the moment of `at`: poses, positions and velocities of vertices, or scalars with
  // their rates.
  virtual void Drive(const EvalContext& at, State& state) const = 0;
  // True if what it drives depends on coordinates of the state: a step drives it again at its end.
  virtual bool follows_coordinates() const { return false; }
  // Returns why what it has driven cannot be right, with the remedy; empty if nothing is wrong. For people: a warning
  // of every output, and the cause of a divergence.
  virtual std::string Warning(const State& /*state*/) const { return {}; }
  // Adds to the coordinates the generalised forces of the forces on the vertices that it drives, by virtual work:
  // Q_j += sum_i f_i . dx_i/dq_j. Linear in `f`, 3 x n [N].
  virtual void TransferForces(const EvalContext& /*at*/, MutablePoints /*f*/) const {}

 protected:
  explicit Motion(std::string name) : name_(std::move(name)) {}

 private:
  std::string name_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_MOTION_H_
