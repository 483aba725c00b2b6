#include "server/mechanics/integrators/semi_implicit_euler.h"

#include <cmath>
#include <limits>

#include "server/mechanics/advance.h"
#include "server/mechanics/vertex_kernel.h"

namespace phrenic {
namespace {

void TakeDriven(const Model& model, const Points& x, const Points& v, std::vector<Eigen::Vector3d>& driven) {
  driven.clear();
  for (const int i : model.driven_vertices) driven.insert(driven.end(), {x.col(i), v.col(i)});
}

void PutDriven(const Model& model, const std::vector<Eigen::Vector3d>& driven, Points& x, Points& v) {
  auto next = driven.begin();
  for (const int i : model.driven_vertices) x.col(i) = *next++, v.col(i) = *next++;
}

// The constraint that a block's vertices are brought onto while they are at hand, if it is the only one.
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

// The end of the step is written over what `work` has of the last one's start, and the two change places, so that
// nothing is copied but what motions have already driven on.
absl::Status SemiImplicitEuler::Advance(const Model& model, const v1::Parameters& parameters, double dt, State& state,
                                        Workspace& work) const {
  TakeDriven(model, state.x, state.v, work.driven);
  DriveMotions(model, parameters, dt, state);
  const Instant at = Packed(model, MakeInstant(model, parameters, state));
  SumSharedDamping(model, at, work.shared_damping);
  const bool held_back = !work.shared_damping.empty();
  const Constraint* in_blocks = held_back ? nullptr : InBlocks(model);
  // How far a block gets is noted while it is at hand, unless vertices are moved yet.
  const bool later = held_back || (!model.constraints.empty() && in_blocks == nullptr);
  if (!later) MakePlaces(state.x.cols(), work.reach);
  const bool whole = SumWholeForces(model, at, work.force);
  ForEachBlock({0, state.x.cols()}, [&](const VertexRange& block) {
    const Eigen::Index vertices = block.end - block.first;
    alignas(64) double memory[3 * kVertexBlock];
    Eigen::Map<Points> own(memory, 3, vertices);
    MutablePoints f = whole ? MutablePoints(work.force.middleCols(block.first, vertices)) : MutablePoints(own);
    AddForcesIn(block, model, at, !whole, f);
    KickAndDrift(block, model.inverse_mass, dt, dt, f, state.x, state.v, work.before, work.velocity_before);
    if (in_blocks) in_blocks->ProjectIn(block, parameters, state.x, dt, work.before, work.velocity_before);
    if (!later) NoteReach(block, work.before, work.velocity_before, work.reach);
  });
  if (held_back) HoldBack(model, dt, state, work.shared_damping, work.before, work.velocity_before);
  state.x.swap(work.before);
  state.v.swap(work.velocity_before);
  PutDriven(model, work.driven, work.before, work.velocity_before);
  if (later) ProjectPositions(model, parameters, work.before, dt, state);
  return absl::OkStatus();
}

}  // namespace phrenic
