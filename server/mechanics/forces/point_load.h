// A prescribed load on selected vertices: f_i = F s / n on each of the n free ones, F the total force [N], s = 1, or
// breath_force signal(t) if scaled_by_breath is set. E = -sum f_i.x_i [J].
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_POINT_LOAD_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_POINT_LOAD_H_

#include <vector>

#include "server/mechanics/block_force.h"
#include "server/mechanics/model_builder.h"

namespace phrenic {

class PointLoad final : public BlockForce {
 public:
  // Returns null, and reports it, if no vertex is free or the force is 0. INVALID_ARGUMENT if the scene selects no
  // vertices, or by both region and list.
  static absl::StatusOr<std::unique_ptr<Force>> Make(const v1::PointLoad& scene, const std::string& name,
                                                     std::string_view path, ModelBuilder& builder);

  void AddForceToBlock(const VertexRange& range, const BlockContext& at, MutablePoints f) const override;
  double Energy(const EvalContext& at) const override;
  bool conservative() const override { return true; }

 private:
  explicit PointLoad(std::string name) : BlockForce(std::move(name)) {}
  Eigen::Vector3d LoadAt(const EvalContext& at) const;

  std::vector<int> vertices_;  // ascending
  Eigen::Vector3d load_;       // on each vertex [N]
  bool scaled_by_breath_ = false;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_POINT_LOAD_H_
