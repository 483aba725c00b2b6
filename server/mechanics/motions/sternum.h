// The sternum follows the anterior ends of the ribs that carry it: the rigid motion in the midsagittal plane (turn
// about x, shift in y and z) that fits them best in the least-squares sense. Nothing moves it sideways: what the ribs'
// ends travel outwards is the costal cartilages' to take up.
#ifndef PHRENIC_SERVER_MECHANICS_MOTIONS_STERNUM_H_
#define PHRENIC_SERVER_MECHANICS_MOTIONS_STERNUM_H_

#include <vector>

#include "server/mechanics/model_builder.h"

namespace phrenic {

class Sternum final : public Motion {
 public:
  static absl::StatusOr<std::unique_ptr<Motion>> Make(const v1::Sternum& scene, const std::string& name,
                                                      std::string_view path, ModelBuilder& builder);

  // Reads the poses that the ribs' motion has set before.
  void Drive(const EvalContext& at, State& state) const override;

 private:
  struct RibEnd {
    int pose;
    Eigen::Vector3d rest;  // [m]
  };
  explicit Sternum(std::string name) : Motion(std::move(name)) {}

  std::vector<RibEnd> ends_;
  std::vector<int> poses_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_MOTIONS_STERNUM_H_
