// A model's state that is stepped, with its parameters.
#ifndef PHRENIC_SERVER_SESSION_RUN_H_
#define PHRENIC_SERVER_SESSION_RUN_H_

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "phrenic/v1/session.pb.h"
#include "server/mechanics/model.h"
#include "server/mechanics/step/step_checkpoint.h"

namespace phrenic::session {

inline constexpr double kTimeTolerance = 1e-9;  // rounding of a long sum of steps [s]

// A moment of a run, from which another run may continue.
struct Fork {
  v1::Parameters parameters;  // every field set and in range
  State state;
  double stable_step = 0;  // the largest stable step for the parameters [s]
};

// Equal models, parameters and states have equal futures, bit for bit. Not thread-safe. No step allocates. A session's
// stepping thread, an export, a replay each own one. A step may use the threads of the mechanics, but returns after
// they are done.
class Run {
 public:
  // Starts at t = 0. Requires, here and below: every field of `parameters` is set and in range.
  Run(std::shared_ptr<const Model> model, v1::Parameters parameters);
  // Starts from `state`, which is a state of the model.
  Run(std::shared_ptr<const Model> model, v1::Parameters parameters, State state);

  // Takes one step of parameters.time_step. Returns OUT_OF_RANGE if it diverges: divergence() then says where and why,
  // the state stays the last good one, and every later step returns FAILED_PRECONDITION until Reset. After a divergence
  // it computes the state before the step again from a checkpoint, which takes longer.
  absl::Status Step();
  // Returns to t = 0 and keeps parameters and pulls. Forgets a divergence.
  void Reset();

  const Model& model() const { return *model_; }
  // Valid until the next call that changes the run.
  const State& state() const { return state_; }
  const v1::Parameters& parameters() const { return parameters_; }
  // Returns the solver effort of the last step.
  const SolverEffort& effort() const { return work_.effort; }
  // Requires: every field of `parameters` is set. They take effect at the next step.
  void set_parameters(const v1::Parameters& parameters);
  // Same as phrenic::ChangePulls: RESOURCE_EXHAUSTED if there are too many. `alone` removes the pulls on all other
  // vertices.
  absl::Status ChangePulls(const std::vector<VertexPull>& changes, bool alone);
  // nullopt while the run is good.
  const std::optional<v1::Divergence>& divergence() const { return divergence_; }
  // Restores the divergence of a saved run.
  void set_divergence(const v1::Divergence& divergence) { divergence_ = divergence; }

 private:
  const std::shared_ptr<const Model> model_;
  v1::Parameters parameters_;
  State state_;
  Workspace work_;             // buffers of a step, made once
  StepCheckpoint checkpoint_;  // forgotten when parameters, pulls or the state change otherwise than by a step
  std::optional<v1::Divergence> divergence_;
};

// Returns "the session diverged at t = 1.2 s ... at vertex 7 of lung, pulled most by springs:lung: ...".
std::string Describe(const v1::Divergence& divergence);

// Returns StateHash in hexadecimal, 16 digits. Equal states have equal hashes; clients compare runs by it.
std::string HashText(const State& state);

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_RUN_H_
