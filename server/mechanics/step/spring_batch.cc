#include "server/mechanics/step/spring_batch.h"

#include <string>
#include <vector>

#include "absl/strings/str_join.h"

namespace phrenic {
namespace {

std::string JointName(std::span<const Springs* const> members) {
  return absl::StrJoin(members, " + ", [](std::string* out, const Springs* springs) { out->append(springs->name()); });
}

SpringRows Lay(std::span<const Springs* const> members, const Points& rest) {
  const auto vertices = static_cast<int>(rest.cols());
  const Precision precision = members.front()->precision();
  if (members.size() == 1) return {members.front()->springs(), vertices, precision};
  std::vector<Spring> all;
  for (const Springs* springs : members) all.insert(all.end(), springs->springs().begin(), springs->springs().end());
  return {all, vertices, precision};
}

}  // namespace

SpringBatch::SpringBatch(std::span<const Springs* const> members, const Points& rest)
    : Force(JointName(members)),
      rows_(Lay(members, rest)),
      packs_(rows_.InRanges() && members.front()->precision() == Precision::kSingle) {
  if (!members.front()->balanced()) return;
  Points load = Points::Zero(3, rest.cols());
  rows_.AddForce(-1, rest, load);
  rows_.SetLoad(load);
}

void SpringBatch::AddForce(const EvalContext& at, MutablePoints f) const {
  rows_.AddForce(at.parameters.elasticity(), at.x, f);
}

void SpringBatch::AddForceIn(const VertexRange& range, const EvalContext& at, MutablePoints f) const {
  rows_.AddForce(range, at.parameters.elasticity(), at.x, at.packed, false, f);
}

void SpringBatch::SetForceIn(const VertexRange& range, const EvalContext& at, MutablePoints f) const {
  rows_.AddForce(range, at.parameters.elasticity(), at.x, at.packed, true, f);
}

}  // namespace phrenic
