// Links as scenes list them, and the projection of one.
#ifndef PHRENIC_SERVER_MECHANICS_CONSTRAINTS_LINK_H_
#define PHRENIC_SERVER_MECHANICS_CONSTRAINTS_LINK_H_

#include "server/mechanics/link.h"
#include "server/mechanics/model_builder.h"

namespace phrenic {

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
