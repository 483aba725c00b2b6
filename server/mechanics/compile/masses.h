// The mass of a body's vertices [kg].
#ifndef PHRENIC_SERVER_MECHANICS_COMPILE_MASSES_H_
#define PHRENIC_SERVER_MECHANICS_COMPILE_MASSES_H_

#include "absl/status/statusor.h"
#include "phrenic/v1/scene.pb.h"
#include "server/mechanics/model_builder.h"

namespace phrenic {

// The body's mass, or that of its substance, spread over the vertices by the area, of a solid the volume, around each.
// Half an equal share at least: the vertices of small triangles would else be so light that they set the time step for
// all (on a real diaphragm, half the step). Equal shares where there is neither; a substance without is
// INVALID_ARGUMENT with `path`, the body's.
absl::StatusOr<Eigen::VectorXd> VertexMasses(const v1::Body& body, const Mesh& mesh, std::string_view path);
// Where bodies ask for it, spreads their inertia anew: by the stiffness [N/m] that each vertex meets at rest in the
// direction in which it is stiffest, half an equal share at least. With springs no frequency is then above
// sqrt(2 stiffness/m), the same for all ((a - b)^2 <= 2 a^2 + 2 b^2). To be called once forces are made, which act by
// the masses of before (weight, friction), and before constraints are. INVALID_ARGUMENT where nothing resists a motion
// of such a body.
absl::Status SpreadMassByStiffness(Model& model);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_COMPILE_MASSES_H_
