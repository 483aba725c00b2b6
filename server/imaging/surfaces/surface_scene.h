// Builds the scene of a person's thorax whose bodies are surface files.
#ifndef PHRENIC_SERVER_IMAGING_SURFACES_SURFACE_SCENE_H_
#define PHRENIC_SERVER_IMAGING_SURFACES_SURFACE_SCENE_H_

#include <string>

#include "server/imaging/surfaces/derived_thorax.h"

namespace phrenic::imaging {

struct SurfaceScene {
  v1::Scene scene;
  Fallbacks fallbacks;
};

// Returns the pattern, the scene `thorax`, with the bodies of `surfaces`: those with an anatomy of ribs, cartilages,
// sternum, vertebrae and lungs keep name, shape and place, and so does a diaphragm from a file, which is then seen;
// inner cage and middle surface are derived. All other numbers as PatientScene. Bodies without anatomy, and all else of
// `surfaces`, are left out, so that a scene that was made so gives itself again. INVALID_ARGUMENT if there is no
// diaphragm's file; the errors of ReadSurfaces and DeriveThorax.
absl::StatusOr<SurfaceScene> MakeSurfaceScene(const BodySource& source, const v1::Scene& surfaces,
                                              const v1::Scene& pattern, const std::string& name);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_SURFACES_SURFACE_SCENE_H_
