// Distance constraints that share vertices, restored one after the other: a fixed number of Gauss-Seidel sweeps a step
// over links of constant length (sign 0) or limits of it (sign 1, -1).
//
// A sweep restores each link as Restore in link.h does, but 1.1 times as far (successive over-relaxation): along its
// direction at the start of the step, distributed by inverse mass, velocities changed by the displacement over dt, so
// that momentum and angular momentum are conserved whatever the number of sweeps. Limits are restored only where they
// are violated. Links without common movable vertices have one colour and are restored eight at a time (LinkPacket);
// odd sweeps take the colours backwards. Neighbouring links spoil each other's lengths: what is left after the sweeps
// is the residual [m], which falls with the step and with the number of sweeps. For nets of thousands of links whose
// simultaneous solution (LinkNetwork) would cost more than the rest of the step. SHAKE: Ryckaert, Ciccotti, Berendsen,
// J Comput Phys 1977;23:327. Over-relaxation: Young, Trans Am Math Soc 1954;76:92.
#ifndef PHRENIC_SERVER_MECHANICS_CONSTRAINTS_SWEPT_LINKS_H_
#define PHRENIC_SERVER_MECHANICS_CONSTRAINTS_SWEPT_LINKS_H_

#include <memory>
#include <string>
#include <vector>

#include "absl/types/span.h"
#include "server/mechanics/constraint.h"
#include "server/mechanics/constraints/link_kernel.h"

namespace phrenic {

// Immutable and thread-safe, for threads with scratch memory of their own.
class SweptLinks final : public Constraint {
 public:
  // Reports the links. Requires: sweeps > 0; every link has a movable end.
  static std::unique_ptr<Constraint> Make(const std::string& name, const std::vector<Link>& links, int sweeps,
                                          ModelBuilder& builder);

  void Project(const v1::Parameters& parameters, const ConstPoints& before, double dt, const Scratch& scratch,
               State& state) const override;
  void ProjectVelocities(const v1::Parameters& parameters, const Scratch& scratch, State& state) const override;
  bool smooth() const override { return false; }
  bool SameMotion(const ConstPoints& before, const ConstPoints& after) const override;
  void ListLinks(std::vector<Link>& links) const override;
  double Residual(const State& state) const override;

  double tolerated(double) const override { return tolerated_; }

 private:
  SweptLinks(std::string name, const std::vector<Link>& links, int sweeps);

  struct Memory;  // of one projection
  void Sweep(bool backwards, double dt, Memory& memory, State& state) const;
  // Packets first to end - 1, of one colour.
  void RestoreColour(size_t first, size_t end, double dt, Memory& memory, State& state) const;
  void RestoreTurned(const Link& link, const Eigen::Vector3d& direction, double dt, Memory& memory, State& state) const;
  SweptEnd& EndOf(int vertex, Memory& memory) const;

  std::vector<Link> links_;           // by colour
  std::vector<int> vertices_;         // at their ends, in ascending order: those of the SweptEnds
  std::vector<LinkPacket> packets_;   // of links_
  std::vector<size_t> colour_start_;  // first packet of each colour, then the number of packets
  int sweeps_;
  double tolerated_ = 0;  // [m]
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_CONSTRAINTS_SWEPT_LINKS_H_
