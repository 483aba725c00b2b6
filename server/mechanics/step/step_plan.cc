#include "server/mechanics/step/step_plan.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "server/mechanics/constraint_residual.h"
#include "server/mechanics/damping.h"
#include "server/mechanics/forces/packed_points.h"
#include "server/mechanics/skinning/pose_matrices.h"
#include "server/mechanics/step/bounds.h"

namespace phrenic {
namespace {

// Constraints that share vertices partly undo each other's projection.
constexpr int kRounds = 50;
constexpr double kSatisfied = 1e-11;        // of the scene's size: a smaller residual is good enough
constexpr double kGain = 0.9;               // a round that leaves more of the residual than this is the last
constexpr double kResidualSettled = 1e-12;  // of the largest velocity: a round that changes less is the last

struct VelocitiesBefore {
  Points v;
};

bool FollowsCoordinates(const Model& model) {
  return std::any_of(model.motions.begin(), model.motions.end(),
                     [](const auto& motion) { return motion->follows_coordinates(); });
}

bool SharesDamping(const Model& model) {
  return std::any_of(model.forces.begin(), model.forces.end(),
                     [](const auto& force) { return force->has_shared_damping(); });
}

bool AdvancesScalars(const Model& model) {
  return std::any_of(model.forces.begin(), model.forces.end(),
                     [](const auto& force) { return force->advances_scalars(); });
}

// The constraint that is projected per block: the only one, if it can be and no operation before it needs all blocks.
const BlockConstraint* FindBlockConstraint(const Model& model, bool shares_damping) {
  if (shares_damping || model.constraints.size() != 1) return nullptr;
  return dynamic_cast<const BlockConstraint*>(model.constraints.front().get());
}

bool ReadsNeighbours(const ForceSchedule& schedule) {
  return std::any_of(schedule.by_block.begin(), schedule.by_block.end(),
                     [](const BlockForce* force) { return force->reads_neighbours(); });
}

}  // namespace

StepPlan::StepPlan(const Model& model, ForceSchedule schedule, const IntegratorTable& integrators)
    : model_(model),
      schedule_(std::move(schedule)),
      integrators_(integrators),
      follows_coordinates_(FollowsCoordinates(model)),
      shares_damping_(SharesDamping(model)),
      advances_scalars_(AdvancesScalars(model)),
      block_constraint_(FindBlockConstraint(model, shares_damping_)),
      final_in_blocks_(!shares_damping_ && (model.constraints.empty() || block_constraint_ != nullptr)),
      may_overwrite_start_(final_in_blocks_ && !ReadsNeighbours(schedule_)) {}

std::shared_ptr<const StepPlan> MakeStepPlan(const Model& model, const IntegratorTable& integrators) {
  return std::make_shared<const StepPlan>(model, ScheduleForces(model), integrators);
}

const Integrator& StepPlan::FindIntegrator(const v1::Parameters& parameters) const {
  const auto index = static_cast<size_t>(parameters.integrator());
  return *integrators_[index < integrators_.size() ? index : 0];
}

EvalContext StepPlan::ContextAhead(const v1::Parameters& parameters, double ahead, const State& state,
                                   const Scratch& scratch) const {
  return MakeEvalContext(model_, parameters, state, state.time + ahead,
                         state.phase + ahead / parameters.breath_length(), scratch);
}

void StepPlan::DriveMotions(const v1::Parameters& parameters, double ahead, const Scratch& scratch,
                            State& state) const {
  if (model_.motions.empty()) return;
  const EvalContext at = ContextAhead(parameters, ahead, state, scratch);
  for (const auto& motion : model_.motions) motion->Drive(at, state);
}

void StepPlan::AdvanceScalars(const v1::Parameters& parameters, double dt, const Scratch& scratch, State& state) const {
  if (!advances_scalars_) return;
  const EvalContext end = ContextAhead(parameters, dt, state, scratch);
  for (const auto& force : model_.forces) {
    if (force->advances_scalars()) force->AdvanceScalars(end, state.tick, dt, state.scalars);
  }
}

void StepPlan::SetScalarRates(const EvalContext& at, Eigen::VectorXd& rates) const {
  for (const auto& force : model_.forces) force->SetScalarRates(at, rates);
}

void StepPlan::SumForces(const EvalContext& at, Points& f) const {
  const BlockContext context = WithSharedResults(at);
  const bool first = !SumWholeForces(context, f);
  phrenic::ForEachBlock({0, f.cols()}, [&](const VertexRange& block) {
    AddBlockForces(block, context, first, true, f.middleCols(block.first, block.end - block.first));
  });
  if (!follows_coordinates_) return;
  for (const auto& motion : model_.motions) motion->TransferForces(at, f);
}

void StepPlan::AddToFree(double scale, const Points& shift, Points& x) const {
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    if (model_.inverse_mass[i] > 0) x.col(i) += scale * shift.col(i);
  }
}

void StepPlan::ProjectPositions(const v1::Parameters& parameters, const ConstPoints& before, double dt,
                                const Scratch& scratch, State& state) const {
  double last = std::numeric_limits<double>::infinity();
  for (int round = 0; round < kRounds; ++round) {
    for (const auto& constraint : model_.constraints) constraint->Project(parameters, before, dt, scratch, state);
    if (model_.constraints.size() < 2) return;
    const double left = LargestResidual(model_, state).metres;
    if (left <= kSatisfied * model_.size || left >= kGain * last) return;
    last = left;
  }
}

void StepPlan::ProjectVelocities(const v1::Parameters& parameters, const Scratch& scratch, State& state) const {
  Points& last = scratch.Get<VelocitiesBefore>().v;
  for (int round = 0; round < kRounds; ++round) {
    if (model_.constraints.size() > 1) last = state.v;
    for (const auto& constraint : model_.constraints) constraint->ProjectVelocities(parameters, scratch, state);
    if (model_.constraints.size() < 2) return;
    const double change = (state.v - last).cwiseAbs().maxCoeff();
    if (!(change > kResidualSettled * state.v.cwiseAbs().maxCoeff())) return;
  }
}

BlockContext StepPlan::WithSharedResults(const EvalContext& at) const {
  BlockContext context{at};
  if (schedule_.packing_origin >= 0) context.packed = PackAll(at.x, schedule_.packing_origin, at.scratch);
  if (!model_.attached_vertices.empty()) context.pose_matrices = PoseMatricesOf(at).data();
  return context;
}

// Sets f. Returns false and leaves f unchanged if there is no such force.
bool StepPlan::SumWholeForces(const EvalContext& at, Points& f) const {
  if (schedule_.whole.empty()) return false;
  f.setZero();
  for (const Force* force : schedule_.whole) force->AddForce(at, f);
  return true;
}

// Adds to f, 3 x the block's vertices; sets it if `first`.
void StepPlan::AddBlockForces(const VertexRange& block, const BlockContext& at, bool first, bool with_loads,
                              MutablePoints f) const {
  const auto add = [&](const BlockForce& force) {
    first ? force.SetForceOnBlock(block, at, f) : force.AddForceToBlock(block, at, f);
    first = false;
  };
  for (const BlockForce* force : schedule_.by_block) add(*force);
  if (with_loads && schedule_.loads != nullptr) add(*schedule_.loads);
  if (first) f.setZero();
  for (const VertexPull& pull : at.pulls) {
    if (pull.vertex >= block.first && pull.vertex < block.end) f.col(pull.vertex - block.first) += pull.force;
  }
}

void StepPlan::KeepStart(const State& state, Workspace& work) const {
  work.driven.clear();
  for (const int i : model_.driven_vertices) work.driven.emplace_back(state.x.col(i));
  if (block_constraint_ == nullptr) return;
  for (const int i : block_constraint_->vertices_across_blocks()) work.before.col(i) = state.x.col(i);
}

BlockContext StepPlan::PrepareBlocks(const v1::Parameters& parameters, const State& state, Workspace& work) const {
  BlockContext at = WithSharedResults(MakeEvalContext(model_, parameters, state, work.scratch));
  if (shares_damping_) SumSharedDamping(model_, at, work.shared_damping);
  if (final_in_blocks_) ResizeBounds(work);
  if (follows_coordinates_) {
    SumForces(at, work.force);
  } else {
    SumWholeForces(at, work.force);
  }
  return at;
}

// A step waits for memory most of all. It therefore writes over its start if no operation reads that later, unless
// several threads run it: each would then write what is in another core's cache.
StepEnd StepPlan::ChooseEnd(State& state, Workspace& work) const {
  if (shares_damping_) return {work.before, work.velocity_before};
  return {may_overwrite_start_ && StepThreads() == 1 ? state.x : work.before, state.v};
}

BlockForces StepPlan::SumForces(const VertexRange& block, const BlockContext& at, Workspace& work,
                                BlockMemory& memory) const {
  const Eigen::Index vertices = block.end - block.first;
  if (follows_coordinates_) return {work.force.middleCols(block.first, vertices), VertexLoads()};
  const bool first = schedule_.whole.empty();
  Eigen::Map<Points> own(memory.force, 3, vertices);
  MutablePoints f = first ? MutablePoints(own) : MutablePoints(work.force.middleCols(block.first, vertices));
  AddBlockForces(block, at, first, false, f);
  return {f, schedule_.loads == nullptr ? VertexLoads() : schedule_.loads->LoadsOnBlock(block, at, f)};
}

void StepPlan::ApplySharedDamping(double dt, const State& start, const StepEnd& end, Workspace& work) const {
  if (!shares_damping_ || work.shared_damping.empty()) return;
  work.shared_damping.CorrectStep(dt, model_.inverse_mass, start.v, end.v, end.x);
}

void StepPlan::TakeEnd(const StepEnd& end, State& state, Workspace& work) const {
  if (&end.x != &state.x) state.x.swap(end.x);
  if (&end.v != &state.v) state.v.swap(end.v);
  auto next = work.driven.begin();
  for (const int i : model_.driven_vertices) work.before.col(i) = *next++;
}

void StepPlan::ProjectAcrossBlocks(const v1::Parameters& parameters, double dt, State& state, Workspace& work) const {
  if (block_constraint_ == nullptr) return ProjectPositions(parameters, work.before, dt, work.scratch, state);
  block_constraint_->ProjectAcrossBlocks(parameters, work.before, dt, work.scratch, state);
  phrenic::RecordBounds(block_constraint_->vertices_across_blocks(), state, work);
}

}  // namespace phrenic
