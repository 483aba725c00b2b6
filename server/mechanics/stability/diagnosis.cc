#include "server/mechanics/stability/diagnosis.h"

#include <cmath>
#include <limits>
#include <string>

#include "absl/strings/str_format.h"
#include "server/mechanics/constraint_residual.h"
#include "server/mechanics/stability/largest_step.h"

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
  if (residual.metres > kContradicts * model.size) {
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
