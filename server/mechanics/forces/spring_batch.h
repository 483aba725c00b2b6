// The springs of one or several elements as a step works them out: laid out for the machine as one (spring_rows.h).
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_SPRING_BATCH_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_SPRING_BATCH_H_

#include <memory>
#include <span>
#include <vector>

#include "server/mechanics/forces/spring_rows.h"
#include "server/mechanics/forces/springs.h"

namespace phrenic {

// The sum of its members' forces, but for rounding. What else a force has to say, its members say.
class SpringBatch final : public Force {
 public:
  // Members of one precision, all balanced at rest or none; `rest` is 3 x n [m].
  SpringBatch(std::span<const Springs* const> members, const Points& rest);

  void AddForce(const Instant& at, MutablePoints f) const override;
  bool by_range() const override { return rows_.InRanges(); }
  void AddForceIn(const VertexRange& range, const Instant& at, MutablePoints f) const override;

 private:
  SpringRows rows_;
};

// What a step sums: `forces`, in their order, but for springs; those are in `batches`, which are added to it.
std::vector<const Force*> BatchSprings(const std::vector<std::unique_ptr<Force>>& forces, const Points& rest,
                                       std::vector<std::unique_ptr<Force>>& batches);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_SPRING_BATCH_H_
