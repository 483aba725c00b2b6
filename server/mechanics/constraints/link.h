// One link between two vertices, or a limit of their distance, and how an error of its length is taken back.
#ifndef PHRENIC_SERVER_MECHANICS_CONSTRAINTS_LINK_H_
#define PHRENIC_SERVER_MECHANICS_CONSTRAINTS_LINK_H_

#include <algorithm>
#include <cmath>

#include "server/mechanics/model_builder.h"

namespace phrenic {

struct Link {
  int a, b;              // simulated vertices
  double length;         // to be kept, or the limit [m]
  double inverse_a = 0;  // 1/m of its ends [1/kg]; 0 for what does not move by forces
  double inverse_b = 0;
  int sign = 0;  // 0: keeps its length; 1: must not be longer; -1: must not be shorter

  bool Movable() const { return inverse_a + inverse_b > 0; }
  // |x_b - x_a| - length [m].
  double Stretch(const ConstPoints& x) const { return (x.col(b) - x.col(a)).norm() - length; }
  // (|x_b - x_a|^2 / length^2 - 1) / 2: the relative error of the length, where it is small.
  double RelativeError(const ConstPoints& x) const {
    return 0.5 * ((x.col(b) - x.col(a)).squaredNorm() / (length * length) - 1);
  }
  // The part of an error that is none of a limit's business left out.
  double Violation(double error) const { return sign == 0 ? std::abs(error) : std::max(0.0, sign * error); }
  double Violation(const ConstPoints& x) const { return Violation(RelativeError(x)); }
  // At its limit, or beyond.
  bool Reached(const ConstPoints& x) const { return sign * RelativeError(x) > -1e-8; }
  // How fast it gets longer [m/s].
  double Rate(const State& state) const {
    const Eigen::Vector3d between = state.x.col(b) - state.x.col(a);
    const double now = between.norm();
    return now > 0 ? between.dot(state.v.col(b) - state.v.col(a)) / now : 0;
  }
};

// The vertices of a list, as links of the body as long as they are at rest. Errors name the entry: a vertex that is
// not there, one joined to itself, two in one point.
absl::StatusOr<std::vector<Link>> ListedLinks(const v1::LinkList& list, int body, std::string_view path,
                                              const ModelBuilder& builder);
// The listed ones, or, where nothing is listed, the edges of the body with both vertices in the region (all where it is
// empty) and some length.
absl::StatusOr<std::vector<Link>> ListedOrEdges(bool listed, const v1::LinkList& list, const std::string& region,
                                                int body, std::string_view path, const ModelBuilder& builder);
// The body of this name, which must be deformable.
absl::StatusOr<int> DeformableBody(const std::string& name, std::string_view path, const ModelBuilder& builder);
Link MakeLink(const Model& model, int a, int b);

// Moves both ends by `impulse` [kg m] along the link, against its stretch, and the velocities by the same over dt.
void Pull(const Link& link, const Eigen::Vector3d& impulse, double dt, Points& x, Points& v);

// The same to the velocities alone, by an impulse in kg m/s.
void Push(const Link& link, const Eigen::Vector3d& impulse, State& state);

// Brings the length back in one go (SHAKE): a pull along `direction`, from a to b, which it had at the start of the
// step [m] and which keeps angular momentum; along itself where it has turned too far in one step for that to reach.
// Nothing where both ends are in one point.
void Restore(const Link& link, const Eigen::Vector3d& direction, double dt, Points& x, Points& v);

// Takes the relative velocity along the link from both ends, by their masses.
void StopStretching(const Link& link, State& state);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_CONSTRAINTS_LINK_H_
