// Motion of the sternum: the rigid motion in the midsagittal plane (rotation about x, translation in y and z) that fits
// the anterior ends of its ribs best in the least-squares sense. There is no lateral motion: the costal cartilages
// absorb the lateral displacements of the rib ends. The anterior end of a rib is the mean of the vertices within 8 mm
// of the most anterior one.
#ifndef PHRENIC_SERVER_MECHANICS_MOTIONS_STERNUM_H_
#define PHRENIC_SERVER_MECHANICS_MOTIONS_STERNUM_H_

#include <vector>

#include "server/mechanics/model_builder.h"

namespace phrenic {

class Sternum final : public Motion {
 public:
  // INVALID_ARGUMENT if a body is not ROLE_DRIVEN or fewer than two driven ribs are given.
  static absl::StatusOr<std::unique_ptr<Motion>> Make(const v1::Sternum& scene, const std::string& name,
                                                      std::string_view path, ModelBuilder& builder);

  // Requires: the motion of the ribs has set their poses for this moment.
  void Drive(const EvalContext& at, State& state) const override;

 private:
  struct RibEnd {
    int pose;
    Eigen::Vector3d rest;  // [m]
  };
  explicit Sternum(std::string name) : Motion(std::move(name)) {}

  std::vector<RibEnd> ends_;
  std::vector<int> poses_;  // of the sternum's bodies
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_MOTIONS_STERNUM_H_
