// Attachment of a deformable body to bones (thesis section 3.3, figures 3.6-3.8): a spring and a damper from each
// vertex to a point c that moves with the nearest anchor body,
//   f = w k (c - x) + 2 zeta sqrt(w k m) (c' - v)  [N],  w = 1 - d/radius,
// d the distance to the nearest vertex of an anchor at rest [m], c the vertex's rest position moved with that anchor
// [m], k the stiffness [N/m], zeta the damping ratio, m the vertex's mass [kg]. Independent of the time
// step. Mode THESIS reproduces the thesis (stickTo): f = w k c' dt, the anchor's displacement in this time step dt [s]
// times a stiffness; displacements then depend on the time step, and there is no restoring force.
#ifndef PHRENIC_SERVER_MECHANICS_FORCES_ATTACHMENT_H_
#define PHRENIC_SERVER_MECHANICS_FORCES_ATTACHMENT_H_

#include <vector>

#include "server/mechanics/block_force.h"
#include "server/mechanics/forces/attachment_kernel.h"
#include "server/mechanics/model_builder.h"

namespace phrenic {

class Attachment final : public BlockForce {
 public:
  // Returns null, and reports it, if no free vertex is within the radius. INVALID_ARGUMENT if an anchor is not driven,
  // at rest, or skinned to such bodies.
  static absl::StatusOr<std::unique_ptr<Force>> Make(const v1::Attachment& scene, const std::string& name,
                                                     std::string_view path, ModelBuilder& builder);

  void AddForce(const EvalContext& at, MutablePoints f) const override;
  // Requires: `at.pose_matrices`.
  void AddForceToBlock(const VertexRange& range, const BlockContext& at, MutablePoints f) const override;
  void AddStiffness(const EvalContext& at, StiffnessSink& sink) const override;
  void AddDamping(const EvalContext& at, Eigen::VectorXd& c) const override;

 private:
  struct AttachedVertex {
    int vertex;
    double stiffness, damping;  // [N/m], [N s/m]
    Eigen::Vector3d rest;       // [m]
  };
  // The packets of one block of vertices: for the springs to the rest positions, or for the weights of one pose.
  struct Group {
    Eigen::Index block;
    int pose;  // -1: springs to the rest positions
    size_t first_packet, end_packet;
  };
  struct Groups {
    std::vector<Group> of;      // sorted by block
    std::vector<size_t> first;  // index of each block's first group, then the number of groups
    void Index(Eigen::Index vertices);
  };
  explicit Attachment(std::string name) : BlockForce(std::move(name)) {}
  void AddVertices(const v1::Attachment& scene, const std::vector<int>& anchors, const std::vector<bool>& region,
                   int body, std::vector<SkinWeight>& weights, ModelBuilder& builder);
  void Pack(std::vector<SkinWeight> weights, Eigen::Index vertices);
  void PackInto(std::vector<Group>& groups, int pose, const AttachedVertex& attached, double stiffness, double damping);

  bool thesis_ = false;
  std::vector<AttachedVertex> vertices_;  // sorted by vertex
  Groups rest_groups_, pose_groups_;
  std::vector<HoldPacket> packets_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_FORCES_ATTACHMENT_H_
