// Memory that a step needs.
#ifndef PHRENIC_SERVER_MECHANICS_WORKSPACE_H_
#define PHRENIC_SERVER_MECHANICS_WORKSPACE_H_

#include <deque>
#include <vector>

#include "server/mechanics/linalg/outer_products.h"
#include "server/mechanics/linalg/state_bounds.h"
#include "server/mechanics/scratch.h"
#include "server/mechanics/solver_effort.h"
#include "server/mechanics/state.h"

namespace phrenic {

// Made once per session (Model::MakeWorkspace), so that no step allocates; the first step after a change of integrator
// may. Holds nothing between steps that cannot be computed from model, parameters and state. Not thread-safe.
struct Workspace {
  Workspace() = default;
  Workspace(Workspace&&) noexcept = default;
  Workspace& operator=(Workspace&&) noexcept = default;

  Points before, velocity_before;       // start of the step, for integrators that need it (3 x n) [m], [m/s]
  Points force;                         // 3 x n [N]
  std::vector<Eigen::Vector3d> driven;  // positions of driven vertices at the start of the step [m]
  Eigen::VectorXd damping;              // one per vertex [N s/m]
  OuterProducts shared_damping;         // of the present step, for integrators that use it
  std::vector<StateBounds> bounds;      // after the step, one per block and one more; empty unless recorded
  std::vector<State> trials;            // of adaptive steps; made when first needed
  std::deque<Points> stages;            // see Stage
  SolverEffort effort;                  // of the linear systems of the last step
  Scratch scratch;                      // of forces, constraints and solvers

  // Returns the index-th array of an integrator's stages, 3 x n. Allocates when first needed. References stay valid.
  Points& Stage(size_t index) {
    if (stages.size() <= index) stages.resize(index + 1);
    stages[index].resize(3, force.cols());
    return stages[index];
  }
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_WORKSPACE_H_
