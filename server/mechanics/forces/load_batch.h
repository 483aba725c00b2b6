// What pulls at each vertex whatever the others do, as a step works it out: friction and shared forces in one pass.
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_LOAD_BATCH_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_LOAD_BATCH_H_

#include <span>
#include <vector>

#include "server/mechanics/forces/friction.h"
#include "server/mechanics/forces/shared_force.h"

namespace phrenic {

// The sum of its members' forces: first that of all friction, -c v, then the shared ones in their order. What else a
// force has to say, its members say.
class LoadBatch final : public Force {
 public:
  LoadBatch(std::span<const Friction* const> friction, std::span<const SharedForce* const> shared);

  bool by_range() const override { return true; }
  void AddForceIn(const VertexRange& range, const Instant& at, MutablePoints f) const override;

 private:
  Eigen::VectorXd coefficient_;  // c of all friction, one a simulated vertex [N s/m]; none where there is none
  std::vector<const SharedForce*> shared_;
};

// f += the range's part of these; the friction too, where there is one.
void AddLoadsOf(std::span<const SharedForce* const> shared, const Eigen::VectorXd* coefficient,
                const VertexRange& range, const Instant& at, MutablePoints f);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_LOAD_BATCH_H_
