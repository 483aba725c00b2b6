// The springs of one or several elements as a step works them out: laid out for the machine as one (spring_rows.h).
#ifndef PHRENIC_SERVER_MECHANICS_STEP_SPRING_BATCH_H_
#define PHRENIC_SERVER_MECHANICS_STEP_SPRING_BATCH_H_

#include <span>

#include "server/mechanics/forces/spring_rows.h"
#include "server/mechanics/forces/springs.h"

namespace phrenic {

// The sum of its members' forces, but for rounding. What else a force has to say, its members say.
class SpringBatch final : public Force {
 public:
  // Members of one precision, all balanced at rest or none; `rest` is 3 x n [m].
  SpringBatch(std::span<const Springs* const> members, const Points& rest);

  void AddForce(const EvalContext& at, MutablePoints f) const override;
  // In single precision from `at.packed`, which is to be there (Packed, advance.h).
  bool by_range() const override { return rows_.InRanges(); }
  bool reads_others() const override { return !packs_; }
  void AddForceIn(const VertexRange& range, const EvalContext& at, MutablePoints f) const override;
  void SetForceIn(const VertexRange& range, const EvalContext& at, MutablePoints f) const override;

  const SpringRows& rows() const { return rows_; }
  bool packs() const { return packs_; }

 private:
  SpringRows rows_;
  bool packs_;  // reads `at.packed`
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_STEP_SPRING_BATCH_H_
