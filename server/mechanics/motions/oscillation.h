// Chosen vertices of a deformable body follow x = x0 + a sin(2 pi t / period) (the driven corners of figures 5.1-5.3).
#ifndef PHRENIC_SERVER_MECHANICS_MOTIONS_OSCILLATION_H_
#define PHRENIC_SERVER_MECHANICS_MOTIONS_OSCILLATION_H_

#include <vector>

#include "server/mechanics/model_builder.h"

namespace phrenic {

class Oscillation final : public Motion {
 public:
  // Takes its vertices out of the free ones: their inverse mass becomes 0.
  static absl::StatusOr<std::unique_ptr<Motion>> Make(const v1::Oscillation& scene, const std::string& name,
                                                      std::string_view path, ModelBuilder& builder);

  void Drive(const EvalContext& at, State& state) const override;

 private:
  explicit Oscillation(std::string name) : Motion(std::move(name)) {}

  std::vector<int> vertices_;
  Points rest_;                // 3 x vertices [m]
  Eigen::Vector3d amplitude_;  // [m]
  double frequency_ = 0;       // [rad/s]
  bool scaled_ = false;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_MOTIONS_OSCILLATION_H_
