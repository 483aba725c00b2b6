#include "server/mechanics/step/advance.h"

#include <algorithm>
#include <limits>

#include "server/mechanics/constraint_residual.h"
#include "server/mechanics/forces/packed_points.h"
#include "server/mechanics/linalg/vertex_kernel.h"
#include "server/mechanics/skinning/pose_matrices.h"
#include "server/mechanics/step/load_batch.h"

namespace phrenic {
namespace {

// Constraints that share vertices undo some of each other's work: they are seen to round after round.
constexpr int kRounds = 50;
constexpr double kKept = 1e-11;   // of the scene's size: what is off by less is kept
constexpr double kGain = 0.9;     // a round that leaves more of the residual than this is the last
constexpr double kStill = 1e-12;  // of the largest velocity: a round that changes less is the last

}  // namespace

EvalContext EvalContextAhead(const Model& model, const v1::Parameters& parameters, double ahead, const State& state) {
  return MakeEvalContext(model, parameters, state, state.time + ahead,
                         state.phase + ahead / parameters.breath_length());
}

void DriveMotions(const Model& model, const v1::Parameters& parameters, double ahead, State& state) {
  if (model.motions.empty()) return;
  const EvalContext at = EvalContextAhead(model, parameters, ahead, state);
  for (const auto& motion : model.motions) motion->Drive(at, state);
}

EvalContext Packed(const Model& model, const EvalContext& at) {
  thread_local std::vector<PoseMatrices> columns;
  EvalContext packed = at;
  if (model.packed_from >= 0) packed.packed = PackAll(at.x, model.packed_from);
  if (!model.attached_vertices.empty()) packed.columns = MakePoseMatrices(at.poses, columns).data();
  return packed;
}

void SumForces(const Model& model, const EvalContext& at, Points& f) {
  const EvalContext packed = Packed(model, at);
  const bool fresh = !SumWholeForces(model, packed, f);
  ForEachBlock({0, f.cols()}, [&](const VertexRange& block) {
    AddForcesIn(block, model, packed, fresh, f.middleCols(block.first, block.end - block.first));
  });
}

bool SumWholeForces(const Model& model, const EvalContext& at, Points& f) {
  if (model.whole_forces.empty()) return false;
  f.setZero();
  for (const Force* force : model.whole_forces) force->AddForce(at, f);
  return true;
}

namespace {

void AddForcesBut(const Force* left, const VertexRange& range, const Model& model, const EvalContext& at, bool fresh,
                  MutablePoints f) {
  for (const Force* force : model.range_forces) {
    if (force == left) continue;
    fresh ? force->SetForceIn(range, at, f) : force->AddForceIn(range, at, f);
    fresh = false;
  }
  if (fresh) f.setZero();
  for (const VertexPull& pull : at.pulls) {
    if (pull.vertex >= range.first && pull.vertex < range.end) f.col(pull.vertex - range.first) += pull.force;
  }
}

}  // namespace

void AddForcesIn(const VertexRange& range, const Model& model, const EvalContext& at, bool fresh, MutablePoints f) {
  AddForcesBut(nullptr, range, model, at, fresh, f);
}

VertexLoads AddForcesButLoads(const VertexRange& block, const Model& model, const EvalContext& at, bool fresh,
                              MutablePoints f) {
  AddForcesBut(model.loads, block, model, at, fresh, f);
  return model.loads == nullptr ? VertexLoads() : model.loads->InBlock(block, at, f);
}

void SumDamping(const Model& model, const EvalContext& at, Eigen::VectorXd& c) {
  c.setZero();
  for (const auto& force : model.forces) force->AddDamping(at, c);
}

void SumSharedDamping(const Model& model, const EvalContext& at, OuterProducts& shared) {
  shared.Clear();
  for (const auto& force : model.forces) force->AddSharedDamping(at, shared);
}

void ResizeBounds(Eigen::Index vertices, std::vector<StateBounds>& blocks) {
  blocks.resize((vertices + kVertexBlock - 1) / kVertexBlock + 1);
  blocks.back() = {};
}

void RecordBounds(const VertexRange& block, const StateBounds& reach, std::vector<StateBounds>& blocks) {
  blocks[block.first / kVertexBlock] = reach;
}

void RecordBounds(std::span<const int> vertices, const Points& x, const Points& v, std::vector<StateBounds>& blocks) {
  StateBounds& reach = blocks.back();
  for (const int vertex : vertices) {
    reach.furthest = LargerMagnitude(reach.furthest, x.col(vertex).cwiseAbs().maxCoeff<Eigen::PropagateNaN>());
    reach.fastest = LargerMagnitude(reach.fastest, v.col(vertex).cwiseAbs().maxCoeff<Eigen::PropagateNaN>());
  }
}

void AddToFree(const Model& model, double scale, const Points& shift, Points& x) {
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    if (model.inverse_mass[i] > 0) x.col(i) += scale * shift.col(i);
  }
}

void ProjectPositions(const Model& model, const v1::Parameters& parameters, const ConstPoints& before, double dt,
                      State& state) {
  double last = std::numeric_limits<double>::infinity();
  for (int round = 0; round < kRounds; ++round) {
    for (const auto& constraint : model.constraints) constraint->Project(parameters, before, dt, state);
    if (model.constraints.size() < 2) return;  // it has seen to itself
    const double left = LargestResidual(model, state).metres;
    if (left <= kKept * model.size || left >= kGain * last) return;
    last = left;
  }
}

void ProjectVelocities(const Model& model, const v1::Parameters& parameters, State& state) {
  thread_local Points last;
  for (int round = 0; round < kRounds; ++round) {
    if (model.constraints.size() > 1) last = state.v;
    for (const auto& constraint : model.constraints) constraint->ProjectVelocities(parameters, state);
    if (model.constraints.size() < 2) return;
    const double change = (state.v - last).cwiseAbs().maxCoeff();
    if (!(change > kStill * state.v.cwiseAbs().maxCoeff())) return;
  }
}

}  // namespace phrenic
