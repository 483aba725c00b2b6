#include "server/mechanics/stability/diagnosis.h"

#include <cmath>
#include <limits>
#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/mechanics/constraint_residual.h"
#include "server/mechanics/stability/largest_step.h"
#include "server/mechanics/state_warnings.h"
#include "server/mechanics/step/loose_parts.h"

namespace phrenic {
namespace {

constexpr double kContradicts = 1e-3;  // of the scene's size: a constraint with a larger residual contradicts others

// Returns the squared distance of a vertex from its position at rest [m^2]; infinity if it is not finite.
double DistanceFromRest(const Model& model, const State& state, int vertex) {
  const double squared = (state.x.col(vertex) - model.rest.col(vertex)).squaredNorm();
  return std::isfinite(squared) ? squared : std::numeric_limits<double>::infinity();
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

// The largest force on a vertex.
struct Cause {
  std::string name = "no force", kind;
  double newtons = 0;
};

Cause LargestForceOn(const Model& model, const v1::Parameters& parameters, const State& state, int vertex) {
  const EvalContext at = MakeEvalContext(model, parameters, state);
  Points force(3, state.x.cols());
  Cause largest;
  for (size_t i = 0; i < model.forces.size(); ++i) {
    force.setZero();
    model.forces[i]->AddForce(at, force);
    const double size = force.col(vertex).norm();
    if (size > largest.newtons)
      largest = {model.forces[i]->name(), i < model.force_kinds.size() ? model.force_kinds[i] : "", size};
  }
  for (const VertexPull& pull : state.pulls) {
    if (pull.vertex == vertex && pull.force.norm() > largest.newtons) largest = {"pull", "pull", pull.force.norm()};
  }
  return largest;
}

// What lessens a force of this kind.
std::string Lessen(const std::string& kind) {
  if (kind == "action_line" || kind == "fibres") return "lower breath_force or raise elasticity";
  if (kind == "pull") return "release the pull";
  if (kind == "gravity") return "hold some vertices, lower its acceleration or raise elasticity";
  if (kind == "pressure" || kind == "lungs") return "lower its pressure or raise elasticity";
  if (kind == "contact") return "lower its load, raise its depth, or move the surface less";
  if (kind == "point_load" || kind == "target_spring" || kind == "attachment") return "lower it or raise elasticity";
  return "lower the loads that stretch it, or lower time_step";
}

std::string Remedy(const Model& model, const v1::Parameters& parameters, const State& before, const State& diverged,
                   int vertex, const Cause& cause) {
  if (!before.x.allFinite() || !before.v.allFinite()) {
    return "a position or velocity was no number even before the step: reset";
  }
  const ConstraintResidual residual = LargestResidual(model, before);
  if (parameters.apply_links() && residual.metres > kContradicts * model.size) {
    return absl::StrFormat(
        "%s cannot hold, it is off by %.3g m: take out links that contradict each other or move less",
        std::string(residual.constraint), residual.metres);
  }
  if (const auto warnings = MotionWarnings(model, before); !warnings.empty()) {
    return absl::StrCat(warnings.front(), ", then reset");
  }
  const double stable = LargestStableStep(model, parameters).seconds();
  if (parameters.time_step() > stable) {
    return absl::StrFormat(
        "the time step %.3g s is above the largest stable step %.3g s: set time_step to %.2g or less, or lower "
        "elasticity, then reset",
        parameters.time_step(), stable, 0.9 * stable);
  }
  if (LooseParts(model).of[vertex] >= 0) {
    const double sizes = std::sqrt(DistanceFromRest(model, diverged, vertex)) / model.size;
    return absl::StrFormat(
        "nothing holds this part of the body, and %s has moved it %.3g sizes of the scene away: fix some of its "
        "vertices, join them by springs to others, or take them out, then reset",
        cause.newtons > 0 ? cause.name : "its velocity", sizes);
  }
  return absl::StrFormat(
      "the time step is below the stable limit at rest (%.3g s), so the load is too large for the tissue: %s, then "
      "reset",
      stable, cause.newtons > 0 ? Lessen(cause.kind) : "lower time_step");
}

}  // namespace

v1::Divergence Diagnose(const Model& model, const v1::Parameters& parameters, const absl::Status& why,
                        const State& before, const State& diverged) {
  v1::Divergence divergence;
  const int vertex = FurthestVertex(model, diverged);
  const BodyModel& body = model.BodyOf(vertex);
  divergence.set_time(diverged.time);
  divergence.set_tick(diverged.tick);
  divergence.set_body(body.name);
  divergence.set_vertex(vertex - body.first_vertex);
  const Cause cause = LargestForceOn(model, parameters, before, vertex);
  divergence.set_force(cause.name);
  divergence.set_remedy(absl::IsAborted(why) ? std::string(why.message())
                                             : Remedy(model, parameters, before, diverged, vertex, cause));
  return divergence;
}

}  // namespace phrenic
