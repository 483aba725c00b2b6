#include "server/mechanics/step/load_batch.h"

#include <algorithm>
#include <string>

#include "absl/strings/str_join.h"

namespace phrenic {
namespace {

std::string JoinedName(std::span<const Friction* const> friction, std::span<const SharedForce* const> shared) {
  std::vector<std::string> names;
  for (const Friction* force : friction) names.push_back(force->name());
  for (const SharedForce* force : shared) names.push_back(force->name());
  return absl::StrJoin(names, " + ");
}

}  // namespace

LoadBatch::LoadBatch(std::span<const Friction* const> friction, std::span<const SharedForce* const> shared)
    : BlockForce(JoinedName(friction, shared)), shared_(shared.begin(), shared.end()) {
  for (const Friction* force : friction) {
    coefficient_ = coefficient_.size() == 0 ? force->coefficient() : coefficient_ + force->coefficient();
  }
}

VertexLoads LoadBatch::LoadsOnBlock(const VertexRange& block, const EvalContext& at, MutablePoints f) const {
  VertexLoads loads;
  if (coefficient_.size() > 0) loads.c = coefficient_.data();
  for (const SharedForce* force : shared_) {
    if (!force->ActsOn(block.first / kVertexBlock)) continue;
    const Eigen::Vector3d whole = force->Whole(at);
    if (whole.isZero(0)) continue;
    if (loads.count == VertexLoads::kMost) {
      AddLoads(block, loads, at.v, f);
      loads = {};
    }
    loads.shared[loads.count++] = {force->weights().data(), whole};
  }
  return loads;
}

void LoadBatch::AddForceToBlock(const VertexRange& range, const BlockContext& at, MutablePoints f) const {
  for (Eigen::Index first = range.first; first < range.end; first += kVertexBlock) {
    const VertexRange block = {first, std::min(first + kVertexBlock, range.end)};
    const MutablePoints own = f.middleCols(first - range.first, block.end - first);
    const VertexLoads loads = LoadsOnBlock(block, at, own);
    if (!loads.empty()) AddLoads(block, loads, at.v, own);
  }
}

}  // namespace phrenic
