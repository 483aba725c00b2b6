#include "server/mechanics/step/spring_batch.h"

#include <vector>

#include "absl/strings/str_join.h"

namespace phrenic {
namespace {

SpringRows LayOut(std::span<const Springs* const> members, const Points& rest) {
  const auto vertices = static_cast<int>(rest.cols());
  const Precision precision = members.front()->precision();
  if (members.size() == 1) return {members.front()->springs(), vertices, precision};
  std::vector<Spring> all;
  for (const Springs* springs : members) all.insert(all.end(), springs->springs().begin(), springs->springs().end());
  return {all, vertices, precision};
}

}  // namespace

SpringRows MakeSpringRows(std::span<const Springs* const> members, const Points& rest) {
  SpringRows rows = LayOut(members, rest);
  if (!members.front()->balanced()) return rows;
  Points load = Points::Zero(3, rest.cols());
  rows.AddForce(-1, rest, Scratch(), load);
  rows.SetLoad(load);
  return rows;
}

std::string JoinedName(std::span<const Springs* const> members) {
  return absl::StrJoin(members, " + ", [](std::string* out, const Springs* springs) { out->append(springs->name()); });
}

void SpringBatch::AddForce(const EvalContext& at, MutablePoints f) const {
  rows_.AddForce(at.parameters.elasticity(), at.x, at.scratch, f);
}

void SpringBatch::AddForceToBlock(const VertexRange& block, const BlockContext& at, MutablePoints f) const {
  rows_.AddForce(block, at.parameters.elasticity(), at.x, at.packed, false, f);
}

void SpringBatch::SetForceOnBlock(const VertexRange& block, const BlockContext& at, MutablePoints f) const {
  rows_.AddForce(block, at.parameters.elasticity(), at.x, at.packed, true, f);
}

void ReorderedSpringBatch::AddForce(const EvalContext& at, MutablePoints f) const {
  rows_.AddForce(at.parameters.elasticity(), at.x, at.scratch, f);
}

}  // namespace phrenic
