#include "server/mechanics/solve/link_forces.h"

#include "server/mechanics/solve/implicit_stage.h"

namespace phrenic {
namespace {

constexpr double kApart = 1e-4;  // of a central difference of driven velocities [s]
constexpr int kReleases = 8;     // of limits that would pull or push the wrong way

struct LinkForceMemory {
  VertexBlocks masses;
  Points acceleration;
  State driven;
};

// Adds the accelerations of driven vertices, by central differences of their velocities.
void AddDriven(const StepPlan& plan, const v1::Parameters& parameters, double ahead, const State& state,
               const Scratch& scratch, LinkForceMemory& memory) {
  const std::vector<int>& driven = plan.model().driven_vertices;
  if (driven.empty()) return;
  memory.driven = state;
  for (const double side : {1.0, -1.0}) {
    plan.DriveMotions(parameters, ahead + side * kApart, scratch, memory.driven);
    for (const int i : driven) memory.acceleration.col(i) += side / (2 * kApart) * memory.driven.v.col(i);
  }
}

}  // namespace

void StartConsistently(const StepPlan& plan, const v1::Parameters& parameters, State& state, Workspace& work) {
  if (ActingLinks(plan, parameters, work.scratch) == nullptr) return;
  plan.ProjectVelocities(parameters, work.scratch, state);
  work.velocity_before = state.v;
}

void AddLinkForces(const StepPlan& plan, const v1::Parameters& parameters, double ahead, const State& state, bool first,
                   const Scratch& scratch, Points& f) {
  LinkEquations* const links = ActingLinks(plan, parameters, scratch);
  if (links == nullptr || !links->complete()) return;
  auto& memory = scratch.Get<LinkForceMemory>();
  SetInverseMasses(plan.model(), memory.masses);
  memory.acceleration = f * plan.model().inverse_mass.asDiagonal();
  AddDriven(plan, parameters, ahead, state, scratch, memory);
  first ? links->PlaceReached(state) : links->Turn(state.x);
  for (int pass = 0; pass < kReleases; ++pass) {
    links->Factorise(memory.masses);
    links->Rates(memory.acceleration, links->multipliers);
    links->Centripetal(state.v, links->wanted);
    links->multipliers -= links->wanted;
    links->Solve(links->multipliers);
    if (!links->Release()) break;
    links->Turn(state.x);
  }
  links->AddImpulses(links->multipliers, f);
}

}  // namespace phrenic
