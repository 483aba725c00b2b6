#include "server/mechanics/solve/implicit_stage.h"

#include <algorithm>

#include "server/mechanics/solve/implicit_system.h"
#include "server/mechanics/solve/linked_system.h"

namespace phrenic {
namespace {

constexpr double kStageSettled = 1e-7;   // of the scene's size: displacement of the last Newton step
constexpr double kUsable = 1e-5;         // of the scene's size: the largest such displacement that is good enough
constexpr double kStageResidual = 1e-3;  // relative residual of the linear system: Newton's method corrects the rest
constexpr double kOvershot = 0.9;  // of the residual along a step: if its reverse is larger at the end, it overshot
constexpr double kLeastFraction = 0.1;
constexpr int kShortenings = 6;
constexpr int kClosings = 6;
constexpr double kClosed = 1e-6;  // of a length: a gap that is left to the projection after the step

// A step of Newton's method [m/s], 3 x n. The stiffness leaves out negative terms, so that a step leads downhill; if it
// overshoots the minimum by far it is shortened, by the secant of the residual along it.
struct NewtonStep {
  Points& change;
  double along = 0;  // the residual along it at its start
  int shortened = 0;

  double Along(const Points& residual) const { return residual.cwiseProduct(change).sum(); }
  void Begin(const Points& residual) {
    along = Along(residual);
    shortened = 0;
  }
  bool Overshot(const Points& residual) const {
    return shortened < kShortenings && Along(residual) < -kOvershot * along;
  }
  // Shortens it to a fraction of itself. Returns the fraction.
  double Shorten(const Points& residual) {
    const double fraction = std::max(kLeastFraction, along / (along - Along(residual)));
    change *= fraction;
    along *= fraction;
    ++shortened;
    return fraction;
  }
};

}  // namespace

void PlaceStage(const StepPlan& plan, const v1::Parameters& parameters, const ImplicitStage& stage,
                const Scratch& scratch, State& state) {
  for (Eigen::Index i = 0; i < state.x.cols(); ++i) {
    if (plan.model().inverse_mass[i] > 0) state.x.col(i) = stage.position.col(i) + stage.g * state.v.col(i);
  }
  plan.DriveMotions(parameters, stage.ahead, scratch, state);
}

void StageResidual(const StepPlan& plan, const ImplicitStage& stage, const EvalContext& at, Points& residual) {
  plan.SumForces(at, residual);
  residual = stage.g * residual - (at.v - stage.velocity) * plan.model().mass.asDiagonal();
}

namespace {

// Newton's method for one stage. With links, each step is that of the equations of motion and of the links together:
// their multipliers are unknowns, and their gaps are closed by velocities, which the stiffness of forces weighs.
class StageSolver {
 public:
  StageSolver(const StepPlan& plan, const v1::Parameters& parameters, const ImplicitStage& stage, State& state,
              Workspace& work)
      : plan_(plan),
        model_(plan.model()),
        parameters_(parameters),
        stage_(stage),
        state_(state),
        work_(work),
        system_(work.scratch.Get<ImplicitSystem>(model_)),
        links_(ActingLinks(plan, parameters, work.scratch)),
        last_{.change = work.Stage(0)} {}

  absl::Status Solve() {
    if (links_ != nullptr && !links_->complete()) return TooTangled();
    if (links_ != nullptr) links_->Restart();
    last_.change.setZero();
    for (int step = 0; step < stage_.newton_steps; ++step) {
      Place();
      const EvalContext at = plan_.ContextAhead(parameters_, stage_.ahead, state_, work_.scratch);
      Residual(at, step == 0);
      if (last_.Overshot(work_.force)) {
        const double fraction = last_.Shorten(work_.force);
        plan_.AddToFree(1 - 1 / fraction, last_.change, state_.v);
        continue;
      }
      if (absl::Status solved = TakeStep(at, step == 0); !solved.ok()) return solved;
      if (!(Displacement() > kStageSettled * model_.size) || work_.effort.Spent()) break;
    }
    if (absl::Status closed = CloseGaps(); !closed.ok()) return closed;
    Place();
    const bool usable = last_.shortened == 0 && Displacement() <= kUsable * model_.size;
    if (stage_.newton_steps > 1 && !usable && !work_.effort.Spent()) {
      return absl::AbortedError("Newton's method found no end of the step: lower time_step, or set a step_tolerance");
    }
    return absl::OkStatus();
  }

 private:
  static absl::Status TooTangled() {
    return absl::AbortedError(
        "the links share so many vertices that an implicit step cannot solve them together: use fewer of them, or an "
        "explicit integrator");
  }
  void Place() { PlaceStage(plan_, parameters_, stage_, work_.scratch, state_); }
  double Displacement() const { return stage_.g * last_.change.cwiseAbs().maxCoeff(); }

  // Sets work.force to the residual of the equations of motion, the links' impulses among it. Before the first step the
  // multipliers are those of an explicit step.
  void Residual(const EvalContext& at, bool first) {
    StageResidual(plan_, stage_, at, work_.force);
    if (links_ == nullptr) return;
    links_->Place(state_.x);
    if (first) GuessMultipliers();
    links_->AddImpulses(links_->multipliers, work_.force);
  }

  void GuessMultipliers() {
    SetInverseMasses(model_, masses());
    links_->Factorise(masses());
    Points& free = work_.Stage(0);
    free = work_.force * model_.inverse_mass.asDiagonal();
    links_->Rates(free, links_->multipliers);
    links_->ClosingRates(stage_.g, links_->wanted);
    links_->multipliers -= links_->wanted;
    links_->Solve(links_->multipliers);
    free.setZero();
  }
  VertexBlocks& masses() { return work_.scratch.Get<VertexBlocks>(); }

  absl::Status TakeStep(const EvalContext& at, bool first) {
    system_.Assemble(model_, at, stage_.g);
    if (first && stage_.guess != nullptr) {
      last_.change = *stage_.guess;
    } else {
      last_.change.setZero();
    }
    absl::Status solved = links_ == nullptr
                              ? system_.Solve(model_, at, work_.force, kStageResidual, work_.effort, last_.change)
                              : SolveLinked(at, work_.force);
    if (!solved.ok()) return solved;
    if (links_ != nullptr) links_->AddImpulses(links_->change, work_.force);
    last_.Begin(work_.force);
    plan_.AddToFree(1, last_.change, state_.v);
    return absl::OkStatus();
  }

  absl::Status SolveLinked(const EvalContext& at, const Points& right) {
    links_->SetTension(stage_.g);
    links_->ClosingRates(stage_.g, links_->wanted);
    auto& linked = work_.scratch.Get<LinkedSystem>(model_);
    absl::Status solved = linked.Solve(model_, at, system_, *links_, right, kStageResidual, work_.effort, last_.change);
    links_->multipliers += links_->change;
    return solved;
  }

  // A single Newton step leaves gaps of second order. Closes them with the same matrix, so that stiff tissue gives way
  // as a whole; what then remains is projected after the step.
  absl::Status CloseGaps() {
    if (links_ == nullptr || stage_.newton_steps > 1) return absl::OkStatus();
    for (int pass = 0; pass < kClosings && !work_.effort.Spent(); ++pass) {
      Place();
      links_->Place(state_.x);
      if (!(links_->LargestGap() > kClosed)) break;
      const EvalContext at = plan_.ContextAhead(parameters_, stage_.ahead, state_, work_.scratch);
      last_.change.setZero();
      work_.force.setZero();
      if (absl::Status solved = SolveLinked(at, work_.force); !solved.ok()) return solved;
      plan_.AddToFree(1, last_.change, state_.v);
    }
    return absl::OkStatus();
  }

  const StepPlan& plan_;
  const Model& model_;
  const v1::Parameters& parameters_;
  const ImplicitStage& stage_;
  State& state_;
  Workspace& work_;
  ImplicitSystem& system_;
  LinkEquations* const links_;  // null if there are none, or they are switched off
  NewtonStep last_;
};

}  // namespace

LinkEquations* ActingLinks(const StepPlan& plan, const v1::Parameters& parameters, const Scratch& scratch) {
  if (plan.model().constraints.empty() || !parameters.apply_links()) return nullptr;
  auto& links = scratch.Get<LinkEquations>(plan.model());
  return links.empty() ? nullptr : &links;
}

absl::Status SolveStage(const StepPlan& plan, const v1::Parameters& parameters, const ImplicitStage& stage,
                        State& state, Workspace& work) {
  if (state.x.cols() == 0) {
    plan.DriveMotions(parameters, stage.ahead, work.scratch, state);
    return absl::OkStatus();
  }
  return StageSolver(plan, parameters, stage, state, work).Solve();
}

// Limits that pull at the end of the stage count as equalities: nothing leaves them in it.
void ProjectStage(const StepPlan& plan, const v1::Parameters& parameters, const ImplicitStage& stage,
                  const Points& before, Workspace& work, State& state) {
  plan.ProjectPositions(parameters, before, stage.g, work.scratch, state);
  if (LinkEquations* const links = ActingLinks(plan, parameters, work.scratch); links != nullptr) {
    auto& masses = work.scratch.Get<VertexBlocks>();
    SetInverseMasses(plan.model(), masses);
    links->Release();
    links->Turn(state.x);
    links->Factorise(masses);
    links->Rates(state.v, links->buffer);
    links->Solve(links->buffer);
    links->AddResponse(links->buffer, masses, state.v);
  }
  plan.ProjectVelocities(parameters, work.scratch, state);
}

}  // namespace phrenic
