// The mass of a body's vertices [kg].
#ifndef PHRENIC_SERVER_MECHANICS_COMPILE_MASSES_H_
#define PHRENIC_SERVER_MECHANICS_COMPILE_MASSES_H_

#include "absl/status/statusor.h"
#include "phrenic/v1/scene.pb.h"
#include "server/mechanics/model_builder.h"

namespace phrenic {

// Lumps the body's mass (given, or that of its material) at its vertices, by the area around each, or by the volume of
// a solid. Each vertex has at least half of an equal share: vertices of small triangles would otherwise be so light
// that they limit the time step for all (on a real diaphragm, by half). Without area and volume, all vertices have
// equal mass, and a material is INVALID_ARGUMENT "path.material: ...".
absl::StatusOr<Eigen::VectorXd> VertexMasses(const v1::Body& body, const Mesh& mesh, std::string_view path);

// Lumps mass again for bodies of MASS_LUMPING_BY_STIFFNESS: by each vertex' largest stiffness over all directions at
// rest [N/m], at least half of an equal share. Frequencies of springs are then at most sqrt(2 stiffness/m), equal for
// all vertices: (a - b)^2 <= 2 a^2 + 2 b^2. To be called after forces are made, which keep the masses by area (weight,
// friction), and before constraints are. INVALID_ARGUMENT if nothing resists a motion of such a body.
absl::Status SpreadMassByStiffness(Model& model);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_COMPILE_MASSES_H_
