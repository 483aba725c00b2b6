// A muscle with a straight line of action (thesis section 3.4, listing A.1.2). The force on vertex i is
//   f_i = F breath_force signal(t) w_i / sum w  [N], along the line.
// The weight w_i is the fall-off times the mass of the area around vertex i at rest, so that the forces sum to F on any
// mesh. Fall-off of a cylinder: max(0, 1 - d/radius), d the perpendicular distance [m]; vertical: max(0,
// height/radius), the height above the origin [m]. With OVERLAP_SKIP_PULLED, the weight is 0 where an action line that
// precedes this one in the scene has a weight. With the activation a of the muscle's side, F becomes F - (1 - a)(F
// + lung load). Trapped air adds hyperinflation times the air load, independently of the muscle.
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_ACTION_LINE_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_ACTION_LINE_H_

#include "server/mechanics/forces/shared_force.h"

namespace phrenic {

class ActionLine final : public SharedForce {
 public:
  // Returns null, and reports it, if no free vertex has a weight or both force and air load are 0. INVALID_ARGUMENT if
  // the direction is zero or a body is not deformable.
  static absl::StatusOr<std::unique_ptr<Force>> Make(const v1::ActionLine& scene, const std::string& name,
                                                     std::string_view path, ModelBuilder& builder);

  Eigen::Vector3d Whole(const EvalContext& at) const override;

 private:
  ActionLine(std::string name, const v1::ActionLine& scene, const Eigen::Vector3d& direction);

  const v1::Side side_;
  const Eigen::Vector3d force_;   // at signal 1, breath force 1 and full activation [N]
  const Eigen::Vector3d muscle_;  // the part that the activation scales: force plus lung load [N]
  const Eigen::Vector3d air_;     // at hyperinflation 1 [N]
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_ACTION_LINE_H_
