// Fixed points (thesis section 3.3, figures 3.6-3.8) as a spring and damper to the carried point, which does not depend
// on the time step: f = w k (c - x) + 2 zeta sqrt(w k m) (c' - v), w = 1 - d/radius, d the distance to the nearest
// vertex of a carrier at rest, c the vertex's own rest position carried along by that carrier [N]. THESIS: as the
// thesis has it (stickTo), f = w k c' dt, the carrier's displacement in this time step dt [s] times a scale: what a
// vertex travels is proportional to the time step, and nothing brings it back. Kept to reproduce the thesis.
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_ATTACHMENT_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_ATTACHMENT_H_

#include <vector>

#include "server/mechanics/block_force.h"
#include "server/mechanics/forces/attachment_kernel.h"
#include "server/mechanics/model_builder.h"

namespace phrenic {

class Attachment final : public BlockForce {
 public:
  // Null where no vertex is within the radius. SkinDrivers are driven, at rest, or riding on such bodies.
  static absl::StatusOr<std::unique_ptr<Force>> Make(const v1::Attachment& scene, const std::string& name,
                                                     std::string_view path, ModelBuilder& builder);

  void AddForce(const EvalContext& at, MutablePoints f) const override;
  // Requires: `at.pose_matrices`.
  void AddForceToBlock(const VertexRange& range, const BlockContext& at, MutablePoints f) const override;
  void AddStiffness(const EvalContext& at, StiffnessSink& sink) const override;
  void AddDamping(const EvalContext& at, Eigen::VectorXd& c) const override;

 private:
  struct Hold {
    int vertex;
    double stiffness, damping;  // [N/m], [N s/m]
    Eigen::Vector3d rest;       // [m]
  };
  // Holds of one block of vertices: all of them, or those in which one pose has a weight.
  struct Group {
    Eigen::Index block;
    int pose;
    size_t first_packet, end_packet;
  };
  struct Groups {
    std::vector<Group> of;      // by block
    std::vector<size_t> first;  // of each block, and one more
    void Index(Eigen::Index vertices);
  };
  explicit Attachment(std::string name) : BlockForce(std::move(name)) {}
  void AddHolds(const v1::Attachment& scene, const std::vector<int>& carriers, const std::vector<bool>& region,
                int body, std::vector<SkinWeight>& weights, ModelBuilder& builder);
  void Pack(std::vector<SkinWeight> weights, Eigen::Index vertices);
  void PackInto(std::vector<Group>& groups, int pose, const Hold& hold, double stiffness, double damping);

  bool thesis_ = false;
  std::vector<Hold> holds_;  // by vertex
  Groups held_, carried_;
  std::vector<HoldPacket> packets_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_ATTACHMENT_H_
