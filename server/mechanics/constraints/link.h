// One distance constraint between two vertices, an equality or a limit, and its projection.
#ifndef PHRENIC_SERVER_MECHANICS_CONSTRAINTS_LINK_H_
#define PHRENIC_SERVER_MECHANICS_CONSTRAINTS_LINK_H_

#include <algorithm>
#include <cmath>

#include "server/mechanics/model_builder.h"

namespace phrenic {

struct Link {
  int a, b;              // simulated vertices
  double length;         // the prescribed length, or the limit [m]
  double inverse_a = 0;  // 1/m of the ends [1/kg]; 0 if fixed or driven
  double inverse_b = 0;
  int sign = 0;  // 0: equality; 1: upper limit; -1: lower limit

  bool Movable() const { return inverse_a + inverse_b > 0; }
  // |x_b - x_a| - length [m].
  double Stretch(const ConstPoints& x) const { return (x.col(b) - x.col(a)).norm() - length; }
  // (|x_b - x_a|^2 / length^2 - 1) / 2: to first order the relative error of the length.
  double RelativeError(const ConstPoints& x) const {
    return 0.5 * ((x.col(b) - x.col(a)).squaredNorm() / (length * length) - 1);
  }
  // Returns |error| of an equality; of a limit, the part of the error that violates it, or 0.
  double Violation(double error) const { return sign == 0 ? std::abs(error) : std::max(0.0, sign * error); }
  double Violation(const ConstPoints& x) const { return Violation(RelativeError(x)); }
  // True if the limit is reached or violated.
  bool Reached(const ConstPoints& x) const { return sign * RelativeError(x) > -1e-8; }
  // Returns the rate of the length [m/s].
  double Rate(const State& state) const {
    const Eigen::Vector3d between = state.x.col(b) - state.x.col(a);
    const double now = between.norm();
    return now > 0 ? between.dot(state.v.col(b) - state.v.col(a)) / now : 0;
  }
};

// Returns the listed links of a body, with their lengths at rest. INVALID_ARGUMENT names the entry if a vertex does not
// exist, both ends are the same vertex, or the ends coincide.
absl::StatusOr<std::vector<Link>> ListedLinks(const v1::LinkList& list, int body, std::string_view path,
                                              const ModelBuilder& builder);
// Returns the listed links if `listed`; otherwise the edges of the body with both vertices in the region (everywhere if
// it is empty) and a length above 0.
absl::StatusOr<std::vector<Link>> ListedOrEdges(bool listed, const v1::LinkList& list, const std::string& region,
                                                int body, std::string_view path, const ModelBuilder& builder);
// RESOURCE_EXHAUSTED for links that cannot be solved simultaneously (LinkNetwork::complete).
absl::Status TooTangled(std::string_view path, std::size_t links);
// Returns the index of the body of this name. INVALID_ARGUMENT if it does not exist or is not deformable.
absl::StatusOr<int> DeformableBody(const std::string& name, std::string_view path, const ModelBuilder& builder);
// Returns the link between two simulated vertices, with its length at rest.
Link MakeLink(const Model& model, int a, int b);

// Moves end a by inverse_a `impulse` and end b by -inverse_b `impulse` ([kg m], along the link; from a to b shortens
// it), and changes the velocities by the same over dt.
void ApplyPositionImpulse(const Link& link, const Eigen::Vector3d& impulse, double dt, Points& x, Points& v);

// Changes the velocities only, by an impulse [kg m/s] of the same sign.
void ApplyVelocityImpulse(const Link& link, const Eigen::Vector3d& impulse, State& state);

// Restores the length in one step (SHAKE), with an impulse along `direction`, the vector from a to b at the start of
// the step [m], which conserves angular momentum. If the link has turned too far for that direction to have a solution,
// the impulse is along the link itself. Does nothing if both ends coincide.
void Restore(const Link& link, const Eigen::Vector3d& direction, double dt, Points& x, Points& v);

// Removes the relative velocity along the link, distributed to the ends by inverse mass (RATTLE).
void StopStretching(const Link& link, State& state);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_CONSTRAINTS_LINK_H_
