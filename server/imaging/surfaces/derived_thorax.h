// What mechanics needs of a person's thorax and no surface file shows: the inner cage and the diaphragm's middle
// surface.
#ifndef PHRENIC_SERVER_IMAGING_SURFACES_DERIVED_THORAX_H_
#define PHRENIC_SERVER_IMAGING_SURFACES_DERIVED_THORAX_H_

#include <functional>
#include <vector>

#include "absl/status/statusor.h"
#include "phrenic/v1/scene.pb.h"
#include "server/imaging/cage_frame.h"
#include "server/imaging/derived_diaphragm.h"
#include "server/imaging/patient/patient_body.h"
#include "server/imaging/surfaces/voxelised_parts.h"

namespace phrenic::imaging {

// Returns the mesh of a body [m], as MeshSource of the mechanics.
using BodySource = std::function<absl::StatusOr<Mesh>(const v1::Body& body)>;

// True for a body whose shape is the diaphragm's file.
bool IsScannedDiaphragm(const v1::Body& body);

// Returns the scene's surfaces from which others are derived, as they lie in the scene: ribs, cartilages, sternum,
// vertebrae and lungs from files or generated, then the scanned diaphragm if there is one. INVALID_ARGUMENT if two
// bodies have its file; the errors of `source`.
absl::StatusOr<std::vector<PatientBody>> ReadSurfaces(const BodySource& source, const v1::Scene& scene);

// Moves a mesh from its place in the scene back to where the body's scale and offset bring it there.
void TakeBack(const v1::Body& body, Mesh& mesh);

struct DerivedThorax {
  CageFrame frame;
  Mesh cage;                   // [m]: FittedCage::Tube
  DerivedDiaphragm diaphragm;  // its mesh: the scanned one (DrawLayers), or empty
  Fallbacks fallbacks;
};

// Derives both from surfaces. `edge_length` is that of the middle surface [mm]. The errors of VoxeliseParts,
// FindCageFrame and DeriveDiaphragm, and of `go_on`, which is asked before each part and stage. Takes a second or two.
absl::StatusOr<DerivedThorax> DeriveThorax(const std::vector<PatientBody>& surfaces, double edge_length,
                                           const GoOn& go_on = AlwaysGoOn);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_SURFACES_DERIVED_THORAX_H_
