// A muscle as a line (thesis section 3.4, listing A.1.2): f_i = F breath_force signal(t) w_i / sum w, along the line.
// w_i = fall-off times the mass of the area around i at rest, so that the sum over the vertices is F whatever the mesh.
// Cylinder: 1 - d/radius, d the perpendicular distance; vertical: height above the origin over the radius, where
// positive. Where the muscle of its side is active by a alone, F is F - (1 - a)(F + lung load). Air that stays in the
// lungs adds hyperinflation times the air load, whatever the muscle does.
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_ACTION_LINE_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_ACTION_LINE_H_

#include "server/mechanics/forces/shared_force.h"

namespace phrenic {

class ActionLine final : public SharedForce {
 public:
  // Null where no vertex is within reach or the force is 0.
  static absl::StatusOr<std::unique_ptr<Force>> Make(const v1::ActionLine& scene, const std::string& name,
                                                     std::string_view path, ModelBuilder& builder);

  Eigen::Vector3d Whole(const EvalContext& at) const override;

 private:
  ActionLine(std::string name, const v1::ActionLine& scene, const Eigen::Vector3d& direction);

  const v1::Side side_;
  const Eigen::Vector3d force_;   // at signal 1, breath force 1 and full activation [N]
  const Eigen::Vector3d muscle_;  // the part of it that the activation scales: what the lungs pull is not in it [N]
  const Eigen::Vector3d air_;     // at hyperinflation 1 [N]
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_ACTION_LINE_H_
