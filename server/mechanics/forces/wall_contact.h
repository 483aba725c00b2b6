// Contact of a sheet with the inside of a rib cage, along which it slides without friction. With the gap
// g = r - R(turn, z; k) of a vertex of area A, g > 0 outside (breathing/inner_wall.h), and the stiffness c [Pa/m],
//   d = max(0, g - g_0),  E = c A d^2/2  [J],  f = -c A d grad g  [N],  Q_j = c A d dR/dk_j  [J],
// Q the generalised forces on the cage. g_0 is the vertex' own: its gap at rest if it is outside there, and less where
// the wall is to push at rest. Beyond the largest depth the force is constant.
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_WALL_CONTACT_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_WALL_CONTACT_H_

#include <memory>
#include <vector>

#include "server/mechanics/model_builder.h"
#include "server/mechanics/motions/insertion.h"

namespace phrenic {

class WallContact final : public Force {
 public:
  // INVALID_ARGUMENT if no insertion names the wall, or a body is not deformable.
  static absl::StatusOr<std::unique_ptr<Force>> Make(const v1::WallContact& scene, const std::string& name,
                                                     std::string_view path, ModelBuilder& builder);

  void AddForce(const EvalContext& at, MutablePoints f) const override;
  void AddStiffness(const EvalContext& at, StiffnessSink& sink) const override;
  void AddLatentStiffness(const EvalContext& at, StiffnessSink& sink) const override;
  void AddContactNormals(const EvalContext& at, MutablePoints normals) const override;
  void RestOnSurface(const Eigen::VectorXd& pushes) override;
  double Energy(const EvalContext& at) const override;
  bool conservative() const override { return true; }
  // The area of the vertices within a millimetre of the wall [m^2], and the force on it [N].
  std::span<const Output> outputs() const override;
  double Read(size_t output, const EvalContext& at) const override;

 private:
  struct Slider {
    int vertex = 0;
    double area = 0;                    // at rest [m^2]
    double rest_gap = 0, touching = 0;  // gaps at rest, and g_0 [m]
    double rest_gradient = 1;           // length of grad g at rest
  };
  WallContact(std::string name, const v1::WallContact& scene, std::shared_ptr<const CageWall> wall)
      : Force(std::move(name)),
        stiffness_(scene.stiffness()),
        largest_depth_(scene.largest_depth()),
        wall_(std::move(wall)) {}
  void PlaceAtRest(const Model& model);
  void Pack();
  // Calls visit(slider, gap) for those that may touch the wall.
  template <typename Visit>
  void ForEachNear(const EvalContext& at, const Visit& visit) const;
  bool Yields(const Slider& slider, const WallGap& gap) const {
    return gap.gap > slider.touching && gap.gap <= slider.touching + largest_depth_;
  }

  const double stiffness_, largest_depth_;  // [Pa/m], [m]
  const std::shared_ptr<const CageWall> wall_;
  std::vector<Slider> sliders_;
  std::vector<SliderPacket> packets_;  // the same for the kernel
  double margin_ = 3e-3;               // a vertex that is farther inside touches nothing [m]
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_WALL_CONTACT_H_
