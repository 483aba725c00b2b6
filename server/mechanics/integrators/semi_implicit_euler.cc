#include "server/mechanics/integrators/semi_implicit_euler.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "server/mechanics/linalg/vertex_kernel.h"
#include "server/mechanics/step/advance.h"

namespace phrenic {
namespace {

void TakeDriven(const Model& model, const Points& x, std::vector<Eigen::Vector3d>& driven) {
  driven.clear();
  for (const int i : model.driven_vertices) driven.emplace_back(x.col(i));
}

void PutDriven(const Model& model, const std::vector<Eigen::Vector3d>& driven, Points& x) {
  auto next = driven.begin();
  for (const int i : model.driven_vertices) x.col(i) = *next++;
}

void TakeAcross(const Constraint& constraint, const Points& x, Points& before) {
  for (const int i : constraint.across()) before.col(i) = x.col(i);
}

// Whether a block's vertices are to be moved on while others have yet to be: nobody asks where they were, and none of
// them is in another core's cache, as it may be where threads take over each other's blocks.
bool MoveOneByOne(const Model& model) {
  return StepThreads() == 1 && std::none_of(model.range_forces.begin(), model.range_forces.end(),
                                            [](const Force* force) { return force->reads_others(); });
}

// The constraint that a block's vertices are brought onto while they are at hand, if it is the only one; what of it
// joins blocks comes after them.
const Constraint* InBlocks(const Model& model) {
  const bool can = model.constraints.size() == 1 && model.constraints.front()->by_range();
  return can ? model.constraints.front().get() : nullptr;
}

// Makes v_next, where M (v_next - v) = dt f, one for which (M + dt S)(v_next - v) = dt f, and x_next with it.
void HoldBack(const Model& model, double dt, const State& start, OuterProducts& shared, Points& x_next,
              Points& v_next) {
  thread_local Points gain;
  gain = v_next - start.v;
  shared.Correct(
      dt, [&model](const Points& b, Points& y) { y = b * model.inverse_mass.asDiagonal(); }, gain);
  v_next = start.v + gain;
  x_next = start.x;
  AddToFree(model, dt, v_next, x_next);
}

}  // namespace

double SemiImplicitEuler::MaxStep(const Spectrum& spectrum) const {
  const double omega2 = spectrum.omega_max * spectrum.omega_max, c = spectrum.damping_rate;
  if (omega2 == 0) return c > 0 ? 2 / c : std::numeric_limits<double>::infinity();
  return 4 / (c + std::sqrt(c * c + 4 * omega2));
}

// The end of the step is written over its start where nobody asks for that any more, as memory is what a step waits for
// most; elsewhere over what `work` has of the last one's start, and the two change places. Nothing is copied but where
// motions have already driven on, and what constraints ask for.
absl::Status SemiImplicitEuler::Advance(const Model& model, const v1::Parameters& parameters, double dt, State& state,
                                        Workspace& work) const {
  TakeDriven(model, state.x, work.driven);
  const Constraint* const only = InBlocks(model);
  if (only != nullptr) TakeAcross(*only, state.x, work.before);
  DriveMotions(model, parameters, dt, state);
  const EvalContext at = Packed(model, MakeEvalContext(model, parameters, state));
  SumSharedDamping(model, at, work.shared_damping);
  const bool held_back = !work.shared_damping.empty();
  const Constraint* const in_blocks = held_back ? nullptr : only;
  // How far a block gets is noted while it is at hand, unless vertices are moved yet.
  const bool later = held_back || (!model.constraints.empty() && in_blocks == nullptr);
  if (!later) ResizeBounds(state.x.cols(), work.bounds);
  const bool over = !later && MoveOneByOne(model);
  Points &x_next = over ? state.x : work.before, &v_next = held_back ? work.velocity_before : state.v;
  const bool whole = SumWholeForces(model, at, work.force);
  ForEachBlock({0, state.x.cols()}, [&](const VertexRange& block) {
    const Eigen::Index vertices = block.end - block.first;
    alignas(64) double memory[3 * kVertexBlock], start[3 * kVertexBlock];
    Eigen::Map<Points> own(memory, 3, vertices);
    MutablePoints f = whole ? MutablePoints(work.force.middleCols(block.first, vertices)) : MutablePoints(own);
    const VertexLoads loads = AddForcesButLoads(block, model, at, !whole, f);
    const bool constrained = in_blocks != nullptr && in_blocks->ActsIn(block, parameters);
    if (constrained) in_blocks->Remember(block, state.x, start);
    StateBounds reach = KickAndDrift(block, model.inverse_mass, dt, dt, f, loads, state.x, state.v, x_next, v_next);
    if (constrained) {
      const double way = in_blocks->ProjectIn(block, start, dt, x_next, v_next);
      reach = {reach.furthest + way, reach.fastest + way / dt};
    }
    if (!later) RecordBounds(block, reach, work.bounds);
  });
  if (held_back) HoldBack(model, dt, state, work.shared_damping, work.before, work.velocity_before);
  if (!over) state.x.swap(work.before);
  if (held_back) state.v.swap(work.velocity_before);
  PutDriven(model, work.driven, work.before);
  if (in_blocks) {
    in_blocks->ProjectAcross(parameters, work.before, dt, state);
    RecordBounds(in_blocks->across(), state.x, state.v, work.bounds);
  }
  if (later) ProjectPositions(model, parameters, work.before, dt, state);
  return absl::OkStatus();
}

}  // namespace phrenic
