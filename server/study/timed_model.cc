#include "server/study/timed_model.h"

#include <chrono>
#include <memory>
#include <utility>
#include <vector>

#include "server/mechanics/step/step_plan.h"
#include "server/study/cost_trials.h"

namespace phrenic::study {
namespace {

using Clock = std::chrono::steady_clock;

double Since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

// Adds the time from its construction to its destruction to a stage.
class Span {
 public:
  // A call may be split into parts; only the first part counts as a call.
  explicit Span(Stage& stage, bool first = true) : stage_(stage), first_(first), start_(Clock::now()) {}
  Span(const Span&) = delete;
  Span& operator=(const Span&) = delete;
  ~Span() {
    stage_.seconds += Since(start_);
    ++stage_.parts;
    if (first_) ++stage_.calls;
  }

 private:
  Stage& stage_;
  const bool first_;
  const Clock::time_point start_;
};

Stage& NewStage(const char* what, const std::string& element, Stages& stages) {
  return stages.emplace_back(Stage{.stage = what, .element = element, .seconds = 0, .calls = 0, .parts = 0});
}

// Forwards to a Force or BlockForce and times every call.
template <typename Kind>
class TimedKind : public Kind {
 public:
  TimedKind(const Kind& force, Stages& stages)
      : Kind(force.name()),
        force_(force),
        adding_(NewStage("force", force.name(), stages)),
        stiffening_(NewStage("stiffness", force.name(), stages)),
        damping_(NewStage("damping", force.name(), stages)) {}
  void AddForce(const EvalContext& at, MutablePoints f) const override {
    const Span span(adding_);
    force_.AddForce(at, f);
  }
  bool acts_on_vertices() const override { return force_.acts_on_vertices(); }
  void AddStiffness(const EvalContext& at, StiffnessSink& sink) const override {
    const Span span(stiffening_);
    force_.AddStiffness(at, sink);
  }
  void AddLatentStiffness(const EvalContext& at, StiffnessSink& sink) const override {
    const Span span(stiffening_);
    force_.AddLatentStiffness(at, sink);
  }
  void AddDamping(const EvalContext& at, Eigen::VectorXd& c) const override {
    const Span span(damping_);
    force_.AddDamping(at, c);
  }
  void AddSharedDamping(const EvalContext& at, OuterProducts& shared) const override {
    const Span span(damping_);
    force_.AddSharedDamping(at, shared);
  }
  bool has_shared_damping() const override { return force_.has_shared_damping(); }
  void AddViscosity(const EvalContext& at, StiffnessSink& blocks) const override {
    const Span span(damping_);
    force_.AddViscosity(at, blocks);
  }
  bool has_viscosity() const override { return force_.has_viscosity(); }
  void AdvanceScalars(const EvalContext& end, std::int64_t tick, double dt, ScalarState& scalars) const override {
    const Span span(adding_, false);
    force_.AdvanceScalars(end, tick, dt, scalars);
  }
  void SetScalarRates(const EvalContext& at, Eigen::VectorXd& rates) const override {
    force_.SetScalarRates(at, rates);
  }
  bool advances_scalars() const override { return force_.advances_scalars(); }
  double Energy(const EvalContext& at) const override { return force_.Energy(at); }
  bool conservative() const override { return force_.conservative(); }

 protected:
  const Kind& force_;
  Stage &adding_, &stiffening_, &damping_;
};

using TimedForce = TimedKind<Force>;

class TimedBlockForce final : public TimedKind<BlockForce> {
 public:
  using TimedKind<BlockForce>::TimedKind;
  void AddForceToBlock(const VertexRange& block, const BlockContext& at, MutablePoints f) const override {
    const Span span(adding_, block.first == 0);
    force_.AddForceToBlock(block, at, f);
  }
  bool reads_neighbours() const override { return force_.reads_neighbours(); }
};

class TimedMotion final : public Motion {
 public:
  TimedMotion(const Motion& motion, Stages& stages)
      : Motion(motion.name()), motion_(motion), driving_(NewStage("motion", motion.name(), stages)) {}
  void Drive(const EvalContext& at, State& state) const override {
    const Span span(driving_);
    motion_.Drive(at, state);
  }

 private:
  const Motion& motion_;
  Stage& driving_;
};

class TimedConstraint final : public Constraint {
 public:
  TimedConstraint(const Constraint& constraint, Stages& stages)
      : Constraint(constraint.name()),
        constraint_(constraint),
        positions_(NewStage("constraint", constraint.name(), stages)),
        velocities_(NewStage("velocities", constraint.name(), stages)) {}
  void Project(const v1::Parameters& parameters, const ConstPoints& before, double dt, const Scratch& scratch,
               State& state) const override {
    const Span span(positions_);
    constraint_.Project(parameters, before, dt, scratch, state);
  }
  void ProjectVelocities(const v1::Parameters& parameters, const Scratch& scratch, State& state) const override {
    const Span span(velocities_);
    constraint_.ProjectVelocities(parameters, scratch, state);
  }
  bool smooth() const override { return constraint_.smooth(); }
  double tolerated(double size) const override { return constraint_.tolerated(size); }
  void ListLinks(std::vector<Link>& links) const override { constraint_.ListLinks(links); }
  bool SameMotion(const ConstPoints& before, const ConstPoints& after) const override {
    return constraint_.SameMotion(before, after);
  }
  double Residual(const State& state) const override {
    const Span span(positions_);
    return constraint_.Residual(state);
  }

 private:
  const Constraint& constraint_;
  Stage &positions_, &velocities_;
};

// The timed force of the same index, or one of a batch, which the schedule then owns.
const Force& TimedWhole(const Force& force, const Model& model, const Model& timed, ForceSchedule& schedule,
                        Stages& stages) {
  for (size_t i = 0; i < model.forces.size(); ++i) {
    if (model.forces[i].get() == &force) return *timed.forces[i];
  }
  return *schedule.batches.emplace_back(std::make_unique<TimedForce>(force, stages));
}

const BlockForce& TimedBlock(const BlockForce& force, ForceSchedule& schedule, Stages& stages) {
  auto block = std::make_unique<TimedBlockForce>(force, stages);
  const BlockForce& timed = *block;
  schedule.batches.push_back(std::move(block));
  return timed;
}

// Returns the schedule of `timed`. Loads, which the plan folds into other forces, are timed as a separate force.
ForceSchedule TimedSchedule(const Model& model, const Model& timed, Stages& stages) {
  const ForceSchedule& plain = model.plan->schedule();
  ForceSchedule schedule;
  schedule.packing_origin = plain.packing_origin;
  for (const Force* force : plain.whole) {
    schedule.whole.push_back(&TimedWhole(*force, model, timed, schedule, stages));
  }
  for (const BlockForce* force : plain.by_block) schedule.by_block.push_back(&TimedBlock(*force, schedule, stages));
  if (plain.loads != nullptr) schedule.by_block.push_back(&TimedBlock(*plain.loads, schedule, stages));
  return schedule;
}

}  // namespace

std::shared_ptr<const Model> Timed(const Model& model, Stages& stages) {
  auto timed = std::make_shared<Model>();
  timed->scene = model.scene;
  timed->parameters = model.parameters;
  timed->rest = model.rest;
  timed->initial_velocity = model.initial_velocity;
  timed->mass = model.mass;
  timed->inverse_mass = model.inverse_mass;
  timed->size = model.size;
  timed->bound = model.bound;
  for (const auto& motion : model.motions) timed->motions.push_back(std::make_unique<TimedMotion>(*motion, stages));
  for (const auto& force : model.forces) timed->forces.push_back(std::make_unique<TimedForce>(*force, stages));
  timed->attached_vertices = model.attached_vertices;
  for (const auto& constraint : model.constraints) {
    timed->constraints.push_back(std::make_unique<TimedConstraint>(*constraint, stages));
  }
  timed->plan =
      std::make_shared<const StepPlan>(*timed, TimedSchedule(model, *timed, stages), model.plan->integrators());
  return timed;
}

double ClockCost() {
  std::vector<double> seen(1000);
  for (double& seconds : seen) {
    Stage stage;
    { const Span span(stage); }
    seconds = stage.seconds;
  }
  return MiddleMean(std::move(seen));
}

}  // namespace phrenic::study
