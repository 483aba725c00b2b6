// Links of constant length L, its length at rest (tensegrity, thesis sections 2.4 and 3.2).
//
// EXACT: SHAKE and RATTLE. The link pulls along its direction r at the start of the step, so that momentum and angular
// momentum are kept: with w = 1/m, A += w_A/(w_A + w_B) c r and B -= w_B/(w_A + w_B) c r, c such that |B - A| = L, and
// the velocities change by the same over dt; then, for integrators that ask, velocities lose what would stretch it. Any
// number of links a vertex: those that share one are solved together (LinkNetwork), whatever their order. (Ryckaert,
// Ciccotti, Berendsen, J Comput Phys 1977;23:327; symplectic with semi-implicit Euler.) THESIS: equations 2.10-2.11,
// split by the distance that each end has moved in this step, velocities untouched. Kept to reproduce the thesis: it
// does not converge with the step and does not keep momentum. A fixed end does not move.
#ifndef PHRENIC_SERVER_MECHANICS_CONSTRAINTS_RIGID_LINKS_H_
#define PHRENIC_SERVER_MECHANICS_CONSTRAINTS_RIGID_LINKS_H_

#include <vector>

#include "server/mechanics/constraints/link_kernel.h"
#include "server/mechanics/constraints/link_network.h"

namespace phrenic {

class RigidLinks final : public Constraint {
 public:
  // Null where the pairing finds no pair.
  static absl::StatusOr<std::unique_ptr<Constraint>> Make(const v1::RigidLinks& scene, const std::string& name,
                                                          std::string_view path, ModelBuilder& builder);

  void Project(const v1::Parameters& parameters, const ConstPoints& before, double dt, State& state) const override;
  bool by_range() const override { return !thesis_; }
  bool ActsIn(const VertexRange& block, const v1::Parameters& parameters) const override {
    return parameters.apply_links() && !PacketsIn(block).empty();
  }
  void Remember(const VertexRange& block, const ConstPoints& x, double* start) const override;
  double ProjectIn(const VertexRange& block, const double* start, double dt, Points& x, Points& v) const override;
  std::span<const int> across() const override { return across_; }
  void ProjectAcross(const v1::Parameters& parameters, const ConstPoints& before, double dt,
                     State& state) const override;
  void ProjectVelocities(const v1::Parameters& parameters, State& state) const override;
  bool smooth() const override { return !thesis_; }
  double Residual(const State& state) const override;

 private:
  explicit RigidLinks(std::string name) : Constraint(std::move(name)) {}
  void Sort(const std::vector<Link>& links, const Model& model);
  void PackAlone(Eigen::Index vertices);
  absl::Span<const LinkPacket> PacketsIn(const VertexRange& block) const;
  // Their places count from vertex `from` on. Returns what ProjectIn does.
  double RestoreAlone(absl::Span<const LinkPacket> packets, Eigen::Index from, const LinkVectors* directions, double dt,
                      Points& x, Points& v) const;
  void RestoreAcross(const ConstPoints& before, double dt, State& state) const;
  void ProjectThesis(const ConstPoints& before, Points& x) const;

  bool thesis_ = false;
  std::vector<Link> alone_;          // no vertex that moves has another link (or the projection asks for no more)
  std::vector<LinkPacket> packets_;  // the same: by block those that lie in one, then the others
  std::vector<size_t> block_start_;  // of each block's packets, and their end
  std::vector<int> across_;          // ends of the others and of the network's
  LinkNetwork network_;              // of links that share vertices
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_CONSTRAINTS_RIGID_LINKS_H_
