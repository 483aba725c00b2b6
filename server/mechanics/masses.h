// The mass of a body's vertices [kg].
#ifndef PHRENIC_SERVER_MECHANICS_MASSES_H_
#define PHRENIC_SERVER_MECHANICS_MASSES_H_

#include "absl/status/statusor.h"
#include "phrenic/v1/scene.pb.h"
#include "server/mechanics/draft.h"

namespace phrenic {

// The body's mass, or that of its substance, spread over the vertices by the area, of a solid the volume, around each.
// Half an equal share at least: the vertices of small triangles would else be so light that they set the time step for
// all (on a real diaphragm, half the step). Equal shares where there is neither; a substance without is
// INVALID_ARGUMENT with `path`, the body's.
absl::StatusOr<Eigen::VectorXd> VertexMasses(const v1::Body& body, const Mesh& mesh, std::string_view path);
// Where bodies ask for it, spreads their mass anew by the stiffness of the springs that the scene has at each vertex
// (the sum over its springs at rest; by Gershgorin's theorem no frequency is then above sqrt(2 sum/m), the same for
// all), half an equal share at least. To be called between bodies and elements. INVALID_ARGUMENT where no spring acts
// on such a body.
absl::Status SpreadMassByStiffness(Draft& draft);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_MASSES_H_
