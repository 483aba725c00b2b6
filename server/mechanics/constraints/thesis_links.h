// Rigid links as printed in the thesis (equations 2.10-2.11): the correction of a link's length is distributed to its
// ends in proportion to their displacements in this step, link after link; velocities are not changed. A fixed end does
// not move. Kept to reproduce the thesis: it does not converge with the time step and does not conserve momentum. Use
// RigidLinks otherwise.
#ifndef PHRENIC_SERVER_MECHANICS_CONSTRAINTS_THESIS_LINKS_H_
#define PHRENIC_SERVER_MECHANICS_CONSTRAINTS_THESIS_LINKS_H_

#include <string>
#include <utility>
#include <vector>

#include "server/mechanics/constraint.h"
#include "server/mechanics/constraints/link.h"

namespace phrenic {

class ThesisLinks final : public Constraint {
 public:
  ThesisLinks(std::string name, std::vector<Link> links) : Constraint(std::move(name)), links_(std::move(links)) {}

  void Project(const v1::Parameters& parameters, const ConstPoints& before, double dt, const Scratch& scratch,
               State& state) const override;
  bool smooth() const override { return false; }
  double Residual(const State& state) const override;

 private:
  std::vector<Link> links_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_CONSTRAINTS_THESIS_LINKS_H_
