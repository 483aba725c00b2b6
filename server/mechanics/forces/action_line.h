// A muscle as a line (thesis section 3.4, listing A.1.2): f_i = F breath_force signal(t) w_i / sum w, along the line.
// w_i = fall-off times the mass of the area around i at rest, so that the sum over the vertices is F whatever the mesh.
// Cylinder: 1 - d/radius, d the perpendicular distance; vertical: height above the origin over the radius, where
// positive. Where the muscle of its side is active by a alone, F is F - (1 - a)(F + lung load). Air that stays in the
// lungs adds hyperinflation times the air load, whatever the muscle does.
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_ACTION_LINE_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_ACTION_LINE_H_

#include <vector>

#include "server/mechanics/draft.h"

namespace phrenic {

class ActionLine final : public Force {
 public:
  // Null where no vertex is within reach or the force is 0.
  static absl::StatusOr<std::unique_ptr<Force>> Make(const v1::ActionLine& scene, const std::string& name,
                                                     std::string_view path, Draft& draft);

  bool by_range() const override { return true; }
  void AddForceIn(const VertexRange& range, const Instant& at, MutablePoints f) const override;
  double Energy(const Instant& at) const override;
  bool conservative() const override { return true; }

 private:
  ActionLine(std::string name, const v1::ActionLine& scene, const Eigen::Vector3d& direction);
  void NoteBlocks();
  // The sum over its vertices at this moment [N].
  Eigen::Vector3d Whole(const Instant& at) const;

  const v1::Side side_;
  const Eigen::Vector3d force_;   // at signal 1, breath force 1 and full activation [N]
  const Eigen::Vector3d muscle_;  // the part of it that the activation scales: what the lungs pull is not in it [N]
  const Eigen::Vector3d air_;     // at hyperinflation 1 [N]
  Eigen::VectorXd share_;         // a simulated vertex; their sum is 1
  std::vector<bool> acts_;        // on vertices of a block
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_ACTION_LINE_H_
