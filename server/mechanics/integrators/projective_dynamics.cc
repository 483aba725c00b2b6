#include "server/mechanics/integrators/projective_dynamics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "absl/functional/function_ref.h"
#include "server/mechanics/linalg/outer_products.h"
#include "server/mechanics/solve/implicit_stage.h"
#include "server/mechanics/solve/quasi_newton.h"
#include "server/mechanics/step/step_plan.h"

namespace phrenic {
namespace {

constexpr double kTurned = 0.5;  // of the residual along a direction: if its reverse is larger at the end, it is cut
constexpr double kMostCut = 0.1;
constexpr int kCuts = 12;

// Two matrices are kept, since an adaptive step alternates between two lengths.
struct ProjectiveMemory {
  std::unique_ptr<PrefactoredSystem> present, other;
  QuasiNewton quasi_newton;
};

// The search for the velocities at the end of one step.
class Search {
 public:
  Search(const StepPlan& plan, const v1::Parameters& parameters, double dt, ProjectiveMemory& memory, State& state,
         Workspace& work)
      : plan_(plan),
        parameters_(parameters),
        state_(state),
        stage_{.ahead = dt, .g = dt, .position = work.before, .velocity = work.velocity_before, .newton_steps = 0},
        residual_(work.force),
        direction_(work.Stage(0)),
        next_(work.Stage(1)),
        system_(*memory.present),
        memory_(memory.quasi_newton),
        scratch_(work.scratch) {}

  absl::Status Start() {
    Evaluate(residual_);
    return residual_.allFinite() ? absl::OkStatus() : absl::AbortedError("a force is not finite: lower time_step");
  }

  // Takes the old velocities, as far as they lead downhill.
  void Coast() {
    direction_.setZero();
    plan_.AddToFree(1, stage_.velocity, direction_);
    Follow(Downhill);
  }

  bool Iterate() {
    memory_.Times(residual_, system_, direction_);
    return Follow(Downhill);
  }

  // Shifts each part that nothing holds so that the residual has no sum: internal forces then leave its momentum alone.
  void KeepMomentum() {
    if (system_.AllHeld()) return;
    system_.KeepSums(residual_, state_.v);
    Evaluate(residual_);
  }

  // Shortens the velocities, of free parts relative to their mean, until they are passive. Kinetic and potential energy
  // together change by at most -r . v' - (v' - v) . M (v' - v)/2 if the potential energy is convex, since it then rises
  // by at most -dt f . v'.
  void KeepPassive() {
    KeepMomentum();
    if (Passive(residual_)) return;
    system_.MeanVelocity(state_.v, next_);
    direction_.setZero();
    plan_.AddToFree(1, state_.v - next_, direction_);
    state_.v = next_;
    Evaluate(residual_);
    Follow([this](double, double) { return Passive(next_); });
    KeepMomentum();
  }

 private:
  // Sets `residual` to that of the stage's equation [N s]; 0 for fixed and driven vertices.
  void Evaluate(Points& residual) {
    PlaceStage(plan_, parameters_, stage_, scratch_, state_);
    StageResidual(plan_, stage_, plan_.ContextAhead(parameters_, stage_.ahead, state_, scratch_), residual);
    for (Eigen::Index i = 0; i < residual.cols(); ++i) {
      if (plan_.model().inverse_mass[i] == 0) residual.col(i).setZero();
    }
  }

  // Adds a * direction_ to the velocities, a = 1 or less: `enough` accepts the residuals along the direction at its
  // start and end. Returns false if the direction does not lead downhill.
  bool Follow(absl::FunctionRef<bool(double start, double end)> enough) {
    const double start = Dot(residual_, direction_);
    if (!(start > 0)) return false;
    double a = 1, gone = 0;
    for (int cut = 0; cut <= kCuts; ++cut) {
      plan_.AddToFree(a - gone, direction_, state_.v);
      gone = a;
      Evaluate(next_);
      const double end = Dot(next_, direction_);
      if (enough(start, end)) break;
      a *= std::isfinite(end) ? std::max(kMostCut, start / (start - end)) : kMostCut;
    }
    direction_ *= gone;
    memory_.Note(direction_, residual_, next_);
    std::swap(residual_, next_);
    return true;
  }

  static bool Downhill(double start, double end) { return end >= -kTurned * start; }

  // Returns true if r . v' >= -(v' - v) . M (v' - v)/2 [J].
  bool Passive(const Points& residual) const {
    double lost = 0;
    for (Eigen::Index i = 0; i < residual.cols(); ++i) {
      if (plan_.model().inverse_mass[i] > 0) {
        lost += 0.5 * plan_.model().mass[i] * (state_.v.col(i) - stage_.velocity.col(i)).squaredNorm();
      }
    }
    return Dot(residual, state_.v) >= -lost;
  }

  const StepPlan& plan_;
  const v1::Parameters& parameters_;
  State& state_;
  const ImplicitStage stage_;
  Points &residual_, &direction_, &next_;
  PrefactoredSystem& system_;
  QuasiNewton& memory_;
  const Scratch& scratch_;
};

// Returns the memory with the matrix of this step and no quasi-Newton steps.
ProjectiveMemory& Prepare(const Model& model, const v1::Parameters& parameters, double g, int iterations,
                          const Scratch& scratch) {
  auto& memory = scratch.Get<ProjectiveMemory>();
  auto& [present, other, quasi_newton] = memory;
  if (present != nullptr && present->g() != g) std::swap(present, other);
  if (present == nullptr) present = std::make_unique<PrefactoredSystem>(model);
  present->Prepare(model, parameters, g);
  quasi_newton.Restart(static_cast<int>(model.rest.cols()), iterations);
  return memory;
}

}  // namespace

double ProjectiveDynamics::MaxStep(const Spectrum&) const { return std::numeric_limits<double>::infinity(); }

absl::Status ProjectiveDynamics::Advance(const StepPlan& plan, const v1::Parameters& parameters, double dt,
                                         State& state, Workspace& work) const {
  if (state.x.cols() == 0) {
    plan.DriveMotions(parameters, dt, work.scratch, state);
    return absl::OkStatus();
  }
  ProjectiveMemory& memory = Prepare(plan.model(), parameters, dt, iterations_, work.scratch);
  state.v.setZero();
  Search search(plan, parameters, dt, memory, state, work);
  if (absl::Status started = search.Start(); !started.ok()) return started;
  search.Coast();
  for (int i = 0; i < iterations_ && search.Iterate(); ++i) {
  }
  search.KeepPassive();
  plan.ProjectPositions(parameters, work.before, dt, work.scratch, state);
  plan.ProjectVelocities(parameters, work.scratch, state);
  return absl::OkStatus();
}

}  // namespace phrenic
