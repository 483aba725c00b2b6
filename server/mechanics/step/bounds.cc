#include "server/mechanics/step/bounds.h"

#include "server/mechanics/linalg/vertex_kernel.h"

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

}  // namespace

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
  return within(MeasureAll(state, work));
}

}  // namespace phrenic
