// Rotation of the ribs about axes through their heads (thesis equations 3.1-3.3): translation t_i = k T_i [m] and
// rotation vector a_i = k A_i [rad], k the breathing state: 0 at functional residual capacity, 1 at total lung
// capacity. Right rib: A = (-pump, +bucket, 0); left rib its mirror image, (-pump, -bucket, 0) (Wilson et al., J Appl
// Physiol 1987;62:1872). The live parameters pump_handle and bucket_handle scale the two components of A, but not T.
// With the live parameter hyperinflation h, breaths start at k0 = h k_quiet and use the remaining range: k = k0 + (1 -
// k0) k_breath, so that no breath exceeds total lung capacity. If the scene sets `free`, the two components have a k
// each, the coordinates "pump handle" and "bucket handle", which forces move. All free ribs of a scene share them, with
// the inertia of the first motion; ribs of a part of the cage depart from them by the part's own coordinate
// (breathing/cage_quadratic.h). The head is the mean of the vertices
// within 6 mm of the most medial one.
#ifndef PHRENIC_SERVER_MECHANICS_MOTIONS_RIBS_H_
#define PHRENIC_SERVER_MECHANICS_MOTIONS_RIBS_H_

#include <array>
#include <optional>
#include <vector>

#include "server/mechanics/breathing/cage_quadratic.h"
#include "server/mechanics/model_builder.h"

namespace phrenic {

// Names of the coordinates of free ribs.
inline constexpr char kPumpHandle[] = "pump handle", kBucketHandle[] = "bucket handle";
inline constexpr std::array<const char*, kCageParts> kCagePartNames = {"cage sides", "right segment", "left segment"};

class Ribs final : public Motion {
 public:
  // INVALID_ARGUMENT if a body is not ROLE_DRIVEN, is not a rib with number and side, or has no end state.
  static absl::StatusOr<std::unique_ptr<Motion>> Make(const v1::Ribs& scene, const std::string& name,
                                                      std::string_view path, ModelBuilder& builder);

  void Drive(const EvalContext& at, State& state) const override;
  bool follows_coordinates() const override { return free_; }

 private:
  struct Rib {
    int pose;
    Eigen::Vector3d head;                        // [m]
    Eigen::Vector3d rotation;                    // at k = 1, axis times angle [rad]
    Eigen::Vector3d translation;                 // at k = 1 [m]
    std::array<double, kCageParts> weight = {};  // of the parts of the cage
  };
  Ribs(std::string name, double quiet_state) : Motion(std::move(name)), quiet_state_(quiet_state) {}
  void AddCoordinates(const v1::FreeCage& scene, ModelBuilder& builder);
  void DriveByBreath(const EvalContext& at, State& state) const;
  void DriveByCoordinates(const EvalContext& at, State& state) const;
  static void SetPose(const Rib& rib, const Eigen::AngleAxisd& turn, const Eigen::Vector3d& angular_velocity, double k,
                      double k_rate, State& state);

  double quiet_state_;  // k at the peak of a quiet breath
  std::vector<Rib> ribs_;
  bool free_ = false;                                        // moved by the coordinates ...
  Coordinate pump_, bucket_;                                 // ... with k as values
  std::array<std::optional<Coordinate>, kCageParts> parts_;  // those that the cage has
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_MOTIONS_RIBS_H_
