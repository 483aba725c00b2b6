#include "server/mechanics/forces/load_batch.h"

#include <algorithm>
#include <array>
#include <string>

#include "absl/strings/str_join.h"
#include "server/mechanics/vertex_kernel.h"

namespace phrenic {
namespace {

std::string JointName(std::span<const Friction* const> friction, std::span<const SharedForce* const> shared) {
  std::vector<std::string> names;
  for (const Friction* force : friction) names.push_back(force->name());
  for (const SharedForce* force : shared) names.push_back(force->name());
  return absl::StrJoin(names, " + ");
}

// In a block, as many at a time as the kernel takes.
void AddInBlock(std::span<const SharedForce* const> shared, const Eigen::VectorXd* coefficient,
                const VertexRange& block, const Instant& at, MutablePoints f) {
  std::array<SharedLoad, kMostLoads> loads;
  size_t count = 0;
  for (const SharedForce* force : shared) {
    if (!force->ActsOn(block.first / kVertexBlock)) continue;
    const Eigen::Vector3d whole = force->Whole(at);
    if (whole.isZero(0)) continue;
    if (count == kMostLoads) {
      AddLoads(block, coefficient, at.v, loads, f);
      coefficient = nullptr;
      count = 0;
    }
    loads[count++] = {force->share().data(), whole};
  }
  if (coefficient != nullptr || count > 0) AddLoads(block, coefficient, at.v, {loads.data(), count}, f);
}

}  // namespace

LoadBatch::LoadBatch(std::span<const Friction* const> friction, std::span<const SharedForce* const> shared)
    : Force(JointName(friction, shared)), shared_(shared.begin(), shared.end()) {
  for (const Friction* force : friction) {
    coefficient_ = coefficient_.size() == 0 ? force->coefficient() : coefficient_ + force->coefficient();
  }
}

void LoadBatch::AddForceIn(const VertexRange& range, const Instant& at, MutablePoints f) const {
  AddLoadsOf(shared_, coefficient_.size() > 0 ? &coefficient_ : nullptr, range, at, f);
}

void AddLoadsOf(std::span<const SharedForce* const> shared, const Eigen::VectorXd* coefficient,
                const VertexRange& range, const Instant& at, MutablePoints f) {
  for (Eigen::Index first = range.first; first < range.end; first += kVertexBlock) {
    const VertexRange block = {first, std::min(first + kVertexBlock, range.end)};
    AddInBlock(shared, coefficient, block, at, f.middleCols(first - range.first, block.end - first));
  }
}

}  // namespace phrenic
