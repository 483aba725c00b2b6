// What absorbs X-rays in a scene: its closed bodies with tissue, in an outline of the trunk.
#ifndef PHRENIC_SERVER_FLUOROSCOPY_ABSORBERS_H_
#define PHRENIC_SERVER_FLUOROSCOPY_ABSORBERS_H_

#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "server/fluoroscopy/attenuation.h"
#include "server/mechanics/model.h"

namespace phrenic::fluoroscopy {

// A closed surface that changes the attenuation coefficient by `weight` [1/m] from outside to inside. Along a ray, the
// sum of weight times thickness over all surfaces is the line integral of the coefficient, also of surfaces in one
// another: each structure replaces the tissue of the trunk that it lies in.
struct Absorber {
  std::string name;
  Points vertices;  // [m]
  Triangles triangles;
  double weight = 0;
};

// A lung, and the density of its tissue and blood [g/cm^3].
struct LungNow {
  std::string name;
  double density = 0;
};

struct Absorbers {
  std::vector<Absorber> all;
  std::vector<LungNow> lungs;
  std::vector<std::string> open;  // bodies with tissue but open surfaces: they have no inside and are left out
  Eigen::Vector3d isocentre =
      Eigen::Vector3d::Zero();  // middle of the lungs at rest, or of the bones without lungs [m]
};

// Returns the tissue of each body of a scene; nullopt for those without a tissue or a surface. Lobes have none beside a
// lung, which they are drawn in a second time. Thread-safe.
std::vector<std::optional<Tissue>> TissuesOf(const Model& model);

// Returns what absorbs in a state of the scene. A rib is marrow in a shell of cortical bone of 1.2 mm, with which it
// has the mean density of ribs, 1.4 g/cm^3. FAILED_PRECONDITION if no body has a tissue that absorbs. Thread-safe.
absl::StatusOr<Absorbers> AbsorbersAt(const Model& model, const State& state);

}  // namespace phrenic::fluoroscopy

#endif  // PHRENIC_SERVER_FLUOROSCOPY_ABSORBERS_H_
