// A State with its parameters that is stepped, and what became of it.
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

// Not thread-safe; a copy of `state` and `parameters` is a fork. No step allocates.
class Run {
 public:
  Run(std::shared_ptr<const Model> model, v1::Parameters parameters);
  Run(std::shared_ptr<const Model> model, v1::Parameters parameters, State state);

  // One step of parameters.time_step. OUT_OF_RANGE when it diverged: divergence() tells where and why then, the state
  // stays the last good one, and every later step is refused with FAILED_PRECONDITION until Reset.
  absl::Status Step();
  // Back to t = 0; parameters and pulls stay.
  void Reset();

  const Model& model() const { return *model_; }
  const State& state() const { return state_; }
  const v1::Parameters& parameters() const { return parameters_; }
  // Of the last step.
  const SolverEffort& effort() const { return work_.effort; }
  // Every field must be set.
  void set_parameters(const v1::Parameters& parameters);
  // As phrenic::ChangePulls: RESOURCE_EXHAUSTED where they become too many.
  absl::Status ChangePulls(const std::vector<VertexPull>& changes, bool alone);
  const std::optional<v1::Divergence>& divergence() const { return divergence_; }
  // It had diverged before it was saved.
  void set_divergence(const v1::Divergence& divergence) { divergence_ = divergence; }

 private:
  const std::shared_ptr<const Model> model_;
  v1::Parameters parameters_;
  State state_;
  Workspace work_;
  StepCheckpoint trail_;
  std::optional<v1::Divergence> divergence_;
};

// "diverged at t = 1.2 s ... by springs:lung: set time_step to ... or less".
std::string Describe(const v1::Divergence& divergence);

// StateHash in hexadecimal, 16 digits.
std::string HashText(const State& state);

}  // namespace phrenic::session

#endif  // PHRENIC_SERVER_SESSION_RUN_H_
