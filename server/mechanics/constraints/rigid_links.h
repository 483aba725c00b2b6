// Links of constant length L, its length at rest (tensegrity, thesis sections 2.4 and 3.2), by SHAKE and RATTLE.
//
// A link pulls along its direction r at the start of the step, so that momentum and angular momentum are conserved:
// with w = 1/m, A += w_A/(w_A + w_B) c r and B -= w_B/(w_A + w_B) c r, c such that |B - A| = L, and the velocities
// change by the same over dt. ProjectVelocities removes from velocities what would stretch a link. A vertex may have
// any number of links: those that share a vertex are solved together (LinkNetwork), whatever their order. A fixed end
// does not move. (Ryckaert, Ciccotti, Berendsen, J Comput Phys 1977;23:327; symplectic with semi-implicit Euler.) The
// form that the thesis printed is ThesisLinks.
#ifndef PHRENIC_SERVER_MECHANICS_CONSTRAINTS_RIGID_LINKS_H_
#define PHRENIC_SERVER_MECHANICS_CONSTRAINTS_RIGID_LINKS_H_

#include <vector>

#include "server/mechanics/block_constraint.h"
#include "server/mechanics/constraints/link_kernel.h"
#include "server/mechanics/constraints/link_network.h"

namespace phrenic {

class RigidLinks final : public BlockConstraint {
 public:
  // Makes RigidLinks, or ThesisLinks if the scene says so. Null if the pairing finds no pair.
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
  double Residual(const State& state) const override;

 private:
  RigidLinks(std::string name, const std::vector<Link>& links, const Model& model);
  void PackAlone(Eigen::Index vertices);
  absl::Span<const LinkPacket> PacketsIn(const VertexRange& block) const;
  // Vertex indices in packets count from vertex `from`. Returns what ProjectBlock returns.
  double RestoreAlone(absl::Span<const LinkPacket> packets, Eigen::Index from, const LinkVectors* directions, double dt,
                      Points& x, Points& v) const;
  void RestoreAcross(const ConstPoints& before, double dt, const Scratch& scratch, State& state) const;

  std::vector<Link> alone_;          // those of which no end that moves has another link
  std::vector<LinkPacket> packets_;  // the same: first, by block, those with both ends in one block, then the others
  std::vector<size_t> block_start_;  // of each block's packets, and their end
  std::vector<int> across_;          // ends of the others and of the network's
  LinkNetwork network_;              // of links that share vertices
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_CONSTRAINTS_RIGID_LINKS_H_
