#include "server/session/run.h"

#include <utility>

#include "absl/strings/str_format.h"
#include "server/mechanics/pulls.h"
#include "server/mechanics/stability/diagnosis.h"
#include "server/mechanics/step/step.h"

namespace phrenic::session {

Run::Run(std::shared_ptr<const Model> model, v1::Parameters parameters)
    : model_(std::move(model)),
      parameters_(std::move(parameters)),
      state_(model_->InitialState()),
      work_(model_->MakeWorkspace()) {}

Run::Run(std::shared_ptr<const Model> model, v1::Parameters parameters, State state)
    : model_(std::move(model)),
      parameters_(std::move(parameters)),
      state_(std::move(state)),
      work_(model_->MakeWorkspace()) {}

absl::Status Run::Step() {
  if (divergence_.has_value()) return absl::FailedPreconditionError(Describe(*divergence_));
  const double dt = parameters_.time_step();
  checkpoint_.Note(*model_, parameters_, state_);
  absl::Status stepped = phrenic::Step(*model_, parameters_, dt, state_, work_);
  if (stepped.ok()) return stepped;
  State before = checkpoint_.StateBeforeLastStep(*model_, parameters_, dt, work_);
  divergence_ = Diagnose(*model_, parameters_, stepped, before, state_);
  state_ = std::move(before);
  checkpoint_.Forget();
  return absl::OutOfRangeError(Describe(*divergence_));
}

void Run::set_parameters(const v1::Parameters& parameters) {
  parameters_ = parameters;
  checkpoint_.Forget();
}

void Run::Reset() {
  std::vector<VertexPull> pulls = std::move(state_.pulls);
  state_ = model_->InitialState();
  state_.pulls = std::move(pulls);
  divergence_.reset();
  checkpoint_.Forget();
}

absl::Status Run::ChangePulls(const std::vector<VertexPull>& changes, bool alone) {
  checkpoint_.Forget();
  return phrenic::ChangePulls(changes, alone, state_.pulls);
}

std::string Describe(const v1::Divergence& divergence) {
  return absl::StrFormat("the session diverged at t = %.6g s (tick %d) at vertex %d of %s, pulled most by %s: %s",
                         divergence.time(), divergence.tick(), divergence.vertex(), divergence.body(),
                         divergence.force(), divergence.remedy());
}

std::string HashText(const State& state) { return absl::StrFormat("%016x", StateHash(state)); }

}  // namespace phrenic::session
