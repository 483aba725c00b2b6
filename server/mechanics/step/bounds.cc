#include "server/mechanics/step/bounds.h"

#include "server/mechanics/linalg/vertex_kernel.h"
#include "server/mechanics/step/loose_parts.h"

namespace phrenic {
namespace {

StateBounds LargestComponent(const std::vector<StateBounds>& blocks) {
  StateBounds whole;
  for (const StateBounds& block : blocks) {
    whole.furthest = LargerMagnitude(block.furthest, whole.furthest);
    whole.fastest = LargerMagnitude(block.fastest, whole.fastest);
  }
  return whole;
}

StateBounds MeasureAll(const State& state, Workspace& work) {
  ResizeBounds(work);
  ForEachBlock({0, state.x.cols()},
               [&](const VertexRange& block) { RecordBounds(block, BoundsOf(block, state.x, state.v), work); });
  return LargestComponent(work.bounds);
}

// The mean position of each part, which is its centre for equal masses.
Points CentresOf(const LooseParts& parts, const ConstPoints& x) {
  Points centres = Points::Zero(3, parts.count);
  Eigen::VectorXd vertices = Eigen::VectorXd::Zero(parts.count);
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    const int part = parts.of[i];
    if (part < 0) continue;
    centres.col(part) += x.col(i);
    vertices[part] += 1;
  }
  return centres * vertices.cwiseInverse().asDiagonal();
}

bool WithinOfCentres(const Model& model, const LooseParts& parts, const ConstPoints& x) {
  const Points centres = CentresOf(parts, x);
  if (!(centres.cwiseAbs().maxCoeff<Eigen::PropagateNaN>() <= kFurthestFall * model.bound)) return false;
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    const int part = parts.of[i];
    const Eigen::Vector3d from = part < 0 ? Eigen::Vector3d(x.col(i)) : Eigen::Vector3d(x.col(i) - centres.col(part));
    if (!(from.cwiseAbs().maxCoeff<Eigen::PropagateNaN>() <= model.bound)) return false;
  }
  return true;
}

}  // namespace

bool PositionsWithinBounds(const Model& model, const ConstPoints& x) {
  if (x.cols() == 0 || x.cwiseAbs().maxCoeff<Eigen::PropagateNaN>() <= model.bound) return true;
  const LooseParts parts(model);
  return parts.count > 0 && WithinOfCentres(model, parts, x);
}

void ResizeBounds(Workspace& work) {
  work.bounds.resize(static_cast<size_t>(CountBlocks(work.force.cols())) + 1);
  work.bounds.back() = {};
}

void RecordBounds(const VertexRange& block, const StateBounds& bounds, Workspace& work) {
  work.bounds[block.first / kVertexBlock] = bounds;
}

void RecordBounds(std::span<const int> vertices, const State& state, Workspace& work) {
  StateBounds& bounds = work.bounds.back();
  for (const int vertex : vertices) {
    const auto largest = [vertex](const Points& of) {
      return of.col(vertex).cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
    };
    bounds.furthest = LargerMagnitude(bounds.furthest, largest(state.x));
    bounds.fastest = LargerMagnitude(bounds.fastest, largest(state.v));
  }
}

// Recorded bounds are upper bounds: constraints may have moved vertices back since. So a state is beyond them only if
// it is measured to be.
bool WithinBounds(const Model& model, double dt, const State& state, Workspace& work) {
  const auto within = [&](const StateBounds& bounds) {
    return bounds.furthest <= model.bound && bounds.fastest <= 2 * model.bound / dt;
  };
  if (!work.bounds.empty() && within(LargestComponent(work.bounds))) return true;
  const StateBounds measured = MeasureAll(state, work);
  if (within(measured)) return true;
  if (!(measured.fastest <= 2 * model.bound / dt)) return false;
  const auto& parts = work.scratch.Get<LooseParts>(model);
  return parts.count > 0 && WithinOfCentres(model, parts, state.x);
}

}  // namespace phrenic
