// Rigid links: distance constraints |B - A| = L, L the length at rest [m] (tensegrity, thesis sections 2.4 and 3.2), by
// SHAKE and RATTLE.
//
// The correction is along the link's direction r at the start of the step, so that momentum and angular momentum are
// conserved: with w = 1/m, A += w_A/(w_A + w_B) c r and B -= w_B/(w_A + w_B) c r, c such that |B - A| = L, and the
// velocities change by the same over dt. ProjectVelocities removes the velocity components that change a length. A
// vertex may have any number of links; those that share a vertex are solved simultaneously (LinkNetwork), independently
// of their order. A fixed end does not move. (Ryckaert, Ciccotti, Berendsen, J Comput Phys 1977;23:327; symplectic with
// semi-implicit Euler.) The form printed in the thesis is ThesisLinks.
#ifndef PHRENIC_SERVER_MECHANICS_CONSTRAINTS_RIGID_LINKS_H_
#define PHRENIC_SERVER_MECHANICS_CONSTRAINTS_RIGID_LINKS_H_

#include <vector>

#include "server/mechanics/block_constraint.h"
#include "server/mechanics/constraints/link_kernel.h"
#include "server/mechanics/constraints/link_network.h"

namespace phrenic {

class RigidLinks final : public BlockConstraint {
 public:
  // Returns RigidLinks, or ThesisLinks for PROJECTION_THESIS. Returns null, and reports it, if the pairing finds no
  // pair. INVALID_ARGUMENT if the body is not deformable or the scene sets neither pairing nor list.
  static absl::StatusOr<std::unique_ptr<Constraint>> Make(const v1::RigidLinks& scene, const std::string& name,
                                                          std::string_view path, ModelBuilder& builder);

  void Project(const v1::Parameters& parameters, const ConstPoints& before, double dt, const Scratch& scratch,
               State& state) const override;
  bool ActsOnBlock(const VertexRange& block, const v1::Parameters& parameters) const override {
    return parameters.apply_links() && !PacketsIn(block).empty();
  }
  void RecordStart(const VertexRange& block, const ConstPoints& x, double* start) const override;
  double ProjectBlock(const VertexRange& block, const double* start, double dt, Points& x, Points& v) const override;
  std::span<const int> vertices_across_blocks() const override { return across_; }
  void ProjectAcrossBlocks(const v1::Parameters& parameters, const ConstPoints& before, double dt,
                           const Scratch& scratch, State& state) const override;
  void ProjectVelocities(const v1::Parameters& parameters, const Scratch& scratch, State& state) const override;
  void ListLinks(std::vector<Link>& links) const override;
  double Residual(const State& state) const override;

 private:
  RigidLinks(std::string name, const std::vector<Link>& links, const Model& model);
  void PackAlone(Eigen::Index vertices);
  absl::Span<const LinkPacket> PacketsIn(const VertexRange& block) const;
  // Offsets in packets are relative to vertex `from`. Returns what ProjectBlock returns.
  double RestoreAlone(absl::Span<const LinkPacket> packets, Eigen::Index from, const LinkVectors* directions, double dt,
                      Points& x, Points& v) const;
  void RestoreAcross(const ConstPoints& before, double dt, const Scratch& scratch, State& state) const;

  std::vector<Link> alone_;          // links whose movable ends have no other link
  std::vector<LinkPacket> packets_;  // of alone_: first, by block, those within one block, then the others
  std::vector<size_t> block_start_;  // first packet of each block, then the end of the packets within blocks
  std::vector<int> across_;          // ends of the links across blocks and of the network's links, ascending
  LinkNetwork network_;              // of links that share vertices
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_CONSTRAINTS_RIGID_LINKS_H_
