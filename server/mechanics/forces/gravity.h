// Weight: f = m g [N], energy -m g.x.
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_GRAVITY_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_GRAVITY_H_

#include "server/mechanics/draft.h"

namespace phrenic {

class Gravity final : public Force {
 public:
  static absl::StatusOr<std::unique_ptr<Force>> Make(const v1::Gravity& scene, const std::string& name,
                                                     std::string_view path, Draft& draft);

  bool by_range() const override { return true; }
  void AddForceIn(const VertexRange& range, const Instant& at, MutablePoints f) const override;
  double Energy(const Instant& at) const override;
  bool conservative() const override { return true; }

 private:
  explicit Gravity(std::string name) : Force(std::move(name)) {}

  Eigen::VectorXd mass_;          // of the vertices that it pulls at, 0 for others [kg]
  Eigen::Vector3d acceleration_;  // [m/s^2]
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_GRAVITY_H_
