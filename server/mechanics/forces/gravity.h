// Weight: f = m g [N], energy -m g.x.
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_GRAVITY_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_GRAVITY_H_

#include "server/mechanics/draft.h"

namespace phrenic {

class Gravity final : public Force {
 public:
  static absl::StatusOr<std::unique_ptr<Force>> Make(const v1::Gravity& scene, const std::string& name,
                                                     std::string_view path, Draft& draft);

  void AddForce(const Instant& at, MutablePoints f) const override;
  double Energy(const Instant& at) const override;
  bool conservative() const override { return true; }

 private:
  explicit Gravity(std::string name) : Force(std::move(name)) {}

  Points weight_;  // 3 x n [N]
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_GRAVITY_H_
