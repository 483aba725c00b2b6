#include "server/mechanics/integrators/projective_dynamics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "absl/functional/function_ref.h"
#include "server/mechanics/linalg/outer_products.h"
#include "server/mechanics/solve/implicit_stage.h"
#include "server/mechanics/solve/quasi_newton.h"
#include "server/mechanics/step/advance.h"

namespace phrenic {
namespace {

constexpr double kTurned = 0.5;  // of the residual along a way at its start: where it has turned by more, it is cut
constexpr double kMostCut = 0.1;
constexpr int kCuts = 12;

// One step's search for the velocities at its end.
class Search {
 public:
  Search(const Model& model, const v1::Parameters& parameters, double dt, State& state, Workspace& work)
      : model_(model),
        parameters_(parameters),
        state_(state),
        stage_{.ahead = dt, .g = dt, .position = work.before, .velocity = work.velocity_before, .newton_steps = 0},
        residual_(work.force),
        way_(work.stages[0]),
        next_(work.stages[1]),
        system_(*work.prefactored[0]),
        memory_(*work.quasi_newton) {}

  absl::Status Start() {
    Evaluate(residual_);
    return residual_.allFinite() ? absl::OkStatus() : absl::AbortedError("a force is not finite: lower time_step");
  }

  // The old velocities, as far as they lead downhill.
  void Coast() {
    way_.setZero();
    AddToFree(model_, 1, stage_.velocity, way_);
    Follow(Downhill);
  }

  bool Iterate() {
    memory_.Times(residual_, system_, way_);
    return Follow(Downhill);
  }

  // Shortens the velocities found until they are passive: kinetic and potential energy together change by at most
  // -r . v' - (v' - v) . M (v' - v)/2 where the potential one is convex, since it then rises by at most -dt f . v'.
  void KeepPassive() {
    if (Passive(residual_)) return;
    way_.setZero();
    AddToFree(model_, 1, state_.v, way_);
    state_.v.setZero();
    Evaluate(residual_);
    Follow([this](double, double) { return Passive(next_); });
  }

 private:
  // What is missing to the equation [N s]; 0 for fixed and driven vertices.
  void Evaluate(Points& residual) {
    PlaceStage(model_, parameters_, stage_, state_);
    StageResidual(model_, stage_, EvalContextAhead(model_, parameters_, stage_.ahead, state_), residual);
    for (Eigen::Index i = 0; i < residual.cols(); ++i) {
      if (model_.inverse_mass[i] == 0) residual.col(i).setZero();
    }
  }

  // v += a way, a = 1 or as much less as is `enough`, which is asked for the residual along the way at its start and at
  // its end. False where the way leads nowhere.
  bool Follow(absl::FunctionRef<bool(double start, double end)> enough) {
    const double start = Dot(residual_, way_);
    if (!(start > 0)) return false;
    double a = 1, gone = 0;
    for (int cut = 0; cut <= kCuts; ++cut) {
      AddToFree(model_, a - gone, way_, state_.v);
      gone = a;
      Evaluate(next_);
      const double end = Dot(next_, way_);
      if (enough(start, end)) break;
      a *= std::isfinite(end) ? std::max(kMostCut, start / (start - end)) : kMostCut;
    }
    way_ *= gone;
    memory_.Note(way_, residual_, next_);
    std::swap(residual_, next_);
    return true;
  }

  static bool Downhill(double start, double end) { return end >= -kTurned * start; }

  // Whether r . v' >= -(v' - v) . M (v' - v)/2 [J].
  bool Passive(const Points& residual) const {
    double lost = 0;
    for (Eigen::Index i = 0; i < residual.cols(); ++i) {
      if (model_.inverse_mass[i] > 0) {
        lost += 0.5 * model_.mass[i] * (state_.v.col(i) - stage_.velocity.col(i)).squaredNorm();
      }
    }
    return Dot(residual, state_.v) >= -lost;
  }

  const Model& model_;
  const v1::Parameters& parameters_;
  State& state_;
  const ImplicitStage stage_;
  Points &residual_, &way_, &next_;
  PrefactoredSystem& system_;
  QuasiNewton& memory_;
};

// Two matrices are kept, since an adaptive step goes to and fro between two lengths.
void Ready(const Model& model, const v1::Parameters& parameters, double g, int iterations, Workspace& work) {
  auto& [present, other] = work.prefactored;
  if (present != nullptr && present->g() != g) std::swap(present, other);
  if (present == nullptr) present = std::make_unique<PrefactoredSystem>(model);
  present->Prepare(model, parameters, g);
  if (work.quasi_newton == nullptr) work.quasi_newton = std::make_unique<QuasiNewton>();
  work.quasi_newton->Restart(static_cast<int>(model.rest.cols()), iterations);
  work.stages.resize(std::max<size_t>(work.stages.size(), 2));
  for (Points* points : {&work.stages[0], &work.stages[1]}) points->resize(3, model.rest.cols());
}

}  // namespace

double ProjectiveDynamics::MaxStep(const Spectrum&) const { return std::numeric_limits<double>::infinity(); }

absl::Status ProjectiveDynamics::Advance(const Model& model, const v1::Parameters& parameters, double dt, State& state,
                                         Workspace& work) const {
  if (state.x.cols() == 0) {
    DriveMotions(model, parameters, dt, state);
    return absl::OkStatus();
  }
  Ready(model, parameters, dt, iterations_, work);
  state.v.setZero();
  Search search(model, parameters, dt, state, work);
  if (absl::Status started = search.Start(); !started.ok()) return started;
  search.Coast();
  for (int i = 0; i < iterations_ && search.Iterate(); ++i) {
  }
  search.KeepPassive();
  ProjectPositions(model, parameters, work.before, dt, state);
  ProjectVelocities(model, parameters, state);
  return absl::OkStatus();
}

}  // namespace phrenic
