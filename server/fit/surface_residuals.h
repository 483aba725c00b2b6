// A surface of the diaphragm or the lungs at the end of an inspiration, against the model's moved lungs: the signed
// distance of points of the lungs' surface, m . (y - p) - e, with p a moved point, y the nearest point of the file's
// surface and m its normal there. e is the same distance at rest, from a surface at end exhale, if one is given: then
// the template's shape takes no part, and only the motion is compared.
#ifndef PHRENIC_SERVER_FIT_SURFACE_RESIDUALS_H_
#define PHRENIC_SERVER_FIT_SURFACE_RESIDUALS_H_

#include <optional>

#include "absl/status/statusor.h"
#include "server/fit/fit_space.h"
#include "server/fit/least_squares.h"
#include "server/fit/person.h"
#include "server/fit/residuals.h"

namespace phrenic::fit {

enum class SurfaceOf { kDiaphragm, kLungs };  // the first is compared with the lungs' bases alone

struct BreathSurfaces {
  SurfaceOf of = SurfaceOf::kDiaphragm;
  Mesh inhale;                 // [m], LPS
  std::optional<Mesh> exhale;  // the same structure at rest
};

// Parses a surface file (meshio), in mm and LPS unless it declares RAS. INVALID_ARGUMENT "name: ..." also if its extent
// is not that of a diaphragm or a lung, 60 to 600 mm, or it has no triangles.
absl::StatusOr<Mesh> ParseBreathSurface(std::string_view name, std::string_view bytes);

// Adds the residuals of about 1,200 points of each lung. Those within 40 mm of the surfaces take part, whose normals
// agree within 60 degrees, but for those nearest to an open border. Blocks of 40 mm count as one datum, and half of
// them is held out if there are 20. INVALID_ARGUMENT if fewer than 20 points take part.
absl::Status AddSurface(const KindOfData& kind, const BreathSurfaces& surfaces, const Person& person,
                        std::uint64_t split, AllResiduals& all, const FitSpace& space);

}  // namespace phrenic::fit

#endif  // PHRENIC_SERVER_FIT_SURFACE_RESIDUALS_H_
