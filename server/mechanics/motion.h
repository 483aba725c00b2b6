// The family of motions: what moves by a law of its own (bones with the breath, driven vertices).
#ifndef PHRENIC_SERVER_MECHANICS_MOTION_H_
#define PHRENIC_SERVER_MECHANICS_MOTION_H_

#include <string>

#include "server/mechanics/eval_context.h"

namespace phrenic {

// Immutable; any number of threads may call. Motions run in the scene's order, so that one may follow another.
class Motion {
 public:
  virtual ~Motion() = default;
  const std::string& name() const { return name_; }
  // Sets what it drives for the time of `at`: poses, positions and velocities of vertices, or scalars with their rates.
  virtual void Drive(const EvalContext& at, State& state) const = 0;

 protected:
  explicit Motion(std::string name) : name_(std::move(name)) {}

 private:
  std::string name_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_MOTION_H_
