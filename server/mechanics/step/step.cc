#include "server/mechanics/step/step.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_format.h"
#include "server/mechanics/compile/catalogue.h"
#include "server/mechanics/compile/compile.h"
#include "server/mechanics/constraint_residual.h"
#include "server/mechanics/step/adaptive_step.h"
#include "server/mechanics/step/advance.h"

namespace phrenic {
namespace {

constexpr double kNotKept = 1e-3;  // of the scene's size: a constraint that is off by more contradicts others

// Squared distance from rest; infinity where it is not a number.
double DistanceFromRest(const Model& model, const State& state, int vertex) {
  const double squared = (state.x.col(vertex) - model.rest.col(vertex)).squaredNorm();
  return std::isfinite(squared) ? squared : std::numeric_limits<double>::infinity();
}

// Of all blocks, in their order; notes those that the integrator has not.
StateBounds BoundsOf(const State& state, std::vector<StateBounds>& blocks) {
  if (blocks.empty()) {
    ResizeBounds(state.x.cols(), blocks);
    ForEachBlock({0, state.x.cols()},
                 [&](const VertexRange& block) { RecordBounds(block, BoundsOf(block, state.x, state.v), blocks); });
  }
  StateBounds whole;
  for (const StateBounds& block : blocks) {
    whole.furthest = LargerMagnitude(block.furthest, whole.furthest);
    whole.fastest = LargerMagnitude(block.fastest, whole.fastest);
  }
  return whole;
}

// True where every coordinate is a number within the bound, and no velocity one that takes less than `dt` across it:
// constraints may hold positions back while velocities run away. What an integrator has noted may be too much, where
// constraints have since brought vertices back.
bool WithinBounds(const Model& model, double dt, const State& state, std::vector<StateBounds>& blocks) {
  const auto within = [&](const StateBounds& reach) {
    return reach.furthest <= model.bound && reach.fastest <= 2 * model.bound / dt;
  };
  const bool noted = !blocks.empty();
  if (within(BoundsOf(state, blocks))) return true;
  blocks.clear();
  return noted && within(BoundsOf(state, blocks));
}

void KeepBefore(const State& state, Workspace& work) {
  ForEachBlock({0, state.x.cols()}, [&](const VertexRange& block) {
    const Eigen::Index first = 3 * block.first, count = 3 * (block.end - block.first);
    std::copy_n(state.x.data() + first, count, work.before.data() + first);
    std::copy_n(state.v.data() + first, count, work.velocity_before.data() + first);
  });
}

int FurthestVertex(const Model& model, const State& state) {
  int furthest = 0;
  double largest = -1;
  for (int i = 0; i < state.x.cols(); ++i) {
    const double distance = DistanceFromRest(model, state, i);
    if (distance > largest) {
      largest = distance;
      furthest = i;
    }
  }
  return furthest;
}

std::string LargestForceOn(const Model& model, const v1::Parameters& parameters, const State& state, int vertex) {
  const EvalContext at = MakeEvalContext(model, parameters, state);
  Points force(3, state.x.cols());
  std::string name = "no force";
  double largest = -1;
  for (const auto& element : model.forces) {
    force.setZero();
    element->AddForce(at, force);
    const double size = force.col(vertex).norm();
    if (size > largest) {
      largest = size;
      name = element->name();
    }
  }
  for (const VertexPull& pull : state.pulls) {
    if (pull.vertex == vertex && pull.force.norm() > largest) name = "pull";
  }
  return name;
}

std::string Remedy(const Model& model, const v1::Parameters& parameters, const State& before) {
  if (!before.x.allFinite() || !before.v.allFinite()) {
    return "a position or velocity was no number even before the step: reset";
  }
  const ConstraintResidual residual = LargestResidual(model, before);
  if (residual.metres > kNotKept * model.size) {
    return absl::StrFormat(
        "%s cannot hold, it is off by %.3g m: take out links that contradict each other or move less",
        std::string(residual.constraint), residual.metres);
  }
  const double stable = LargestStableStep(model, parameters).seconds();
  if (parameters.time_step() > stable) {
    return absl::StrFormat(
        "the time step %.3g s is above the largest stable step %.3g s: set time_step to %.2g or less, or lower "
        "elasticity, then reset",
        parameters.time_step(), stable, 0.9 * stable);
  }
  return absl::StrFormat(
      "the time step is below the stable limit at rest (%.3g s), so the load is too large for the tissue: lower "
      "breath_force or raise elasticity, then reset",
      stable);
}

}  // namespace

absl::Status Step(const Model& model, const v1::Parameters& parameters, double dt, State& state, Workspace& work) {
  const Integrator& integrator = FindIntegrator(parameters.integrator());
  const bool adaptive = parameters.step_tolerance() > 0 && integrator.order() > 0;
  if (!adaptive && integrator.needs_start()) KeepBefore(state, work);
  work.effort.Begin(parameters.solver_budget());
  work.bounds.clear();
  absl::Status advanced = adaptive ? AdvanceAdaptively(model, parameters, integrator, dt, state, work)
                                   : integrator.Advance(model, parameters, dt, state, work);
  state.time += dt;
  state.phase += dt / parameters.breath_length();
  ++state.tick;
  if (!advanced.ok()) return advanced;
  if (adaptive) work.bounds.clear();  // of a part of the step, or a trial
  if (!WithinBounds(model, dt, state, work.bounds)) return absl::OutOfRangeError("the step diverged");
  return absl::OkStatus();
}

v1::Divergence Diagnose(const Model& model, const v1::Parameters& parameters, const absl::Status& why,
                        const State& before, const State& diverged) {
  v1::Divergence divergence;
  const int vertex = FurthestVertex(model, diverged);
  const BodyModel& body = model.BodyOf(vertex);
  divergence.set_time(diverged.time);
  divergence.set_tick(diverged.tick);
  divergence.set_body(body.name);
  divergence.set_vertex(vertex - body.first_vertex);
  divergence.set_force(LargestForceOn(model, parameters, before, vertex));
  divergence.set_remedy(absl::IsAborted(why) ? std::string(why.message()) : Remedy(model, parameters, before));
  return divergence;
}

}  // namespace phrenic
