// Prescribed harmonic motion of selected vertices of a deformable body: x = x0 + a sin(2 pi t / period) [m], x0 the
// rest position, a the amplitude [m] (the driven corners of thesis figures 5.1-5.3), optionally scaled by the live
// parameter breath_force.
#ifndef PHRENIC_SERVER_MECHANICS_MOTIONS_OSCILLATION_H_
#define PHRENIC_SERVER_MECHANICS_MOTIONS_OSCILLATION_H_

#include <vector>

#include "server/mechanics/model_builder.h"

namespace phrenic {

class Oscillation final : public Motion {
 public:
  // Sets the inverse mass of the vertices to 0, so that forces do not move them. INVALID_ARGUMENT if the body is not
  // deformable or a vertex does not exist.
  static absl::StatusOr<std::unique_ptr<Motion>> Make(const v1::Oscillation& scene, const std::string& name,
                                                      std::string_view path, ModelBuilder& builder);

  void Drive(const EvalContext& at, State& state) const override;

 private:
  explicit Oscillation(std::string name) : Motion(std::move(name)) {}

  std::vector<int> vertices_;
  Points rest_;                // 3 x vertices [m]
  Eigen::Vector3d amplitude_;  // [m]
  double frequency_ = 0;       // angular [rad/s]
  bool scaled_ = false;        // by breath_force
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_MOTIONS_OSCILLATION_H_
