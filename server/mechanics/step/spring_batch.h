// The springs of one or several elements as a step evaluates them: in one layout for vector instructions
// (forces/spring_rows.h).
#ifndef PHRENIC_SERVER_MECHANICS_STEP_SPRING_BATCH_H_
#define PHRENIC_SERVER_MECHANICS_STEP_SPRING_BATCH_H_

#include <span>
#include <string>
#include <utility>

#include "server/mechanics/block_force.h"
#include "server/mechanics/forces/spring_rows.h"
#include "server/mechanics/forces/springs.h"

namespace phrenic {

// Returns the members' springs in one layout. Requires: all members have one precision, and all or none are balanced at
// rest. `rest` is 3 x n [m].
SpringRows MakeSpringRows(std::span<const Springs* const> members, const Points& rest);

// Returns "springs:a + springs:b".
std::string JoinedName(std::span<const Springs* const> members);

// The sum of the members' forces, up to rounding. Stiffness and energy are the members' own.
class SpringBatch final : public BlockForce {
 public:
  // Requires: rows.InRanges().
  SpringBatch(std::string name, SpringRows rows) : BlockForce(std::move(name)), rows_(std::move(rows)) {}

  void AddForce(const EvalContext& at, MutablePoints f) const override;
  // In single precision both read `at.packed` in place of `at.x`.
  void AddForceToBlock(const VertexRange& block, const BlockContext& at, MutablePoints f) const override;
  void SetForceOnBlock(const VertexRange& block, const BlockContext& at, MutablePoints f) const override;
  bool reads_neighbours() const override { return !needs_packed(); }

  const SpringRows& rows() const { return rows_; }
  bool needs_packed() const { return rows_.precision() == Precision::kSingle; }

 private:
  SpringRows rows_;
};

// The same for springs that join vertices far apart: these are evaluated for all vertices at once, in an order of their
// own.
class ReorderedSpringBatch final : public Force {
 public:
  ReorderedSpringBatch(std::string name, SpringRows rows) : Force(std::move(name)), rows_(std::move(rows)) {}
  void AddForce(const EvalContext& at, MutablePoints f) const override;

 private:
  SpringRows rows_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_STEP_SPRING_BATCH_H_
