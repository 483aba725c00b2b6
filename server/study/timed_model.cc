#include "server/study/timed_model.h"

#include <chrono>
#include <memory>
#include <utility>
#include <vector>

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

class TimedForce final : public Force {
 public:
  TimedForce(const Force& force, Stages& stages)
      : Force(force.name()),
        force_(force),
        adding_(NewStage("force", force.name(), stages)),
        stiffening_(NewStage("stiffness", force.name(), stages)),
        damping_(NewStage("damping", force.name(), stages)) {}
  void AddForce(const EvalContext& at, MutablePoints f) const override {
    const Span span(adding_);
    force_.AddForce(at, f);
  }
  bool by_range() const override { return force_.by_range(); }
  bool reads_others() const override { return force_.reads_others(); }
  void AddForceIn(const VertexRange& range, const EvalContext& at, MutablePoints f) const override {
    const Span span(adding_, range.first == 0);
    force_.AddForceIn(range, at, f);
  }
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
  double Energy(const EvalContext& at) const override { return force_.Energy(at); }
  bool conservative() const override { return force_.conservative(); }

 private:
  const Force& force_;
  Stage &adding_, &stiffening_, &damping_;
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
  void Project(const v1::Parameters& parameters, const ConstPoints& before, double dt, State& state) const override {
    const Span span(positions_);
    constraint_.Project(parameters, before, dt, state);
  }
  void ProjectVelocities(const v1::Parameters& parameters, State& state) const override {
    const Span span(velocities_);
    constraint_.ProjectVelocities(parameters, state);
  }
  bool smooth() const override { return constraint_.smooth(); }
  double Residual(const State& state) const override {
    const Span span(positions_);
    return constraint_.Residual(state);
  }

 private:
  const Constraint& constraint_;
  Stage &positions_, &velocities_;
};

const Force& TimedOf(const Force& force, const Model& model, const Model& timed) {
  for (size_t i = 0; i < model.forces.size(); ++i) {
    if (model.forces[i].get() == &force) return *timed.forces[i];
  }
  size_t batch = 0;
  while (model.batches[batch].get() != &force) ++batch;
  return *timed.batches[batch];
}

}  // namespace

Model Timed(const Model& model, Stages& stages) {
  Model timed;
  timed.scene = model.scene;
  timed.parameters = model.parameters;
  timed.rest = model.rest;
  timed.mass = model.mass;
  timed.inverse_mass = model.inverse_mass;
  timed.size = model.size;
  timed.bound = model.bound;
  for (const auto& motion : model.motions) timed.motions.push_back(std::make_unique<TimedMotion>(*motion, stages));
  for (const auto& force : model.forces) timed.forces.push_back(std::make_unique<TimedForce>(*force, stages));
  for (const auto& batch : model.batches) timed.batches.push_back(std::make_unique<TimedForce>(*batch, stages));
  timed.packed_from = model.packed_from;
  timed.attached_vertices = model.attached_vertices;
  for (const Force* force : model.whole_forces) timed.whole_forces.push_back(&TimedOf(*force, model, timed));
  for (const Force* force : model.range_forces) timed.range_forces.push_back(&TimedOf(*force, model, timed));
  for (const auto& constraint : model.constraints) {
    timed.constraints.push_back(std::make_unique<TimedConstraint>(*constraint, stages));
  }
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
