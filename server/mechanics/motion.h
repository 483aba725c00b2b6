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

 protected:
  explicit Motion(std::string name) : name_(std::move(name)) {}

 private:
  std::string name_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_MOTION_H_
