// Derives the diaphragm, which segmentations lack, from the structures on either side of it.
#ifndef PHRENIC_SERVER_IMAGING_DERIVED_DIAPHRAGM_H_
#define PHRENIC_SERVER_IMAGING_DERIVED_DIAPHRAGM_H_

#include "absl/status/statusor.h"
#include "server/imaging/fitted_cage.h"
#include "server/mesh/mesh.h"

namespace phrenic::imaging {

struct DiaphragmOptions {
  int vertices = 20000;           // target, for both layers together; 0: no double layer
  double tendon_share = 0.17;     // of the sheet's area, as of the generated one; 0.15 to 0.25 in humans
  double middle_edge_length = 5;  // [mm]; finer over the spine and in the crura
};

struct DerivedDiaphragm {
  // A closed double layer with a gap of 3 mm [m], LPS.
  Mesh mesh;
  // Its middle surface as one layer [m], facing the thorax, for mechanics. Regions of both: "tendon", "muscle",
  // "crus-right", "crus-left", "rim" (the border), "insertion": what is fixed to bone, the rim, except behind between
  // the crura where it bridges the aorta, and all of the crura below L1.
  Mesh middle;
  v1::DerivedDiaphragm report;
};

// Fits a smooth sheet (SmoothSheet) to the evidence: domes between the lower faces of lungs and heart and the upper
// faces of liver, spleen and stomach; the zone of apposition on the fitted cage, and the sheet nowhere outside of it;
// the crura along the lumbar vertebrae; extrapolated elsewhere. The tendon has the three leaves of the generated one in
// the patient's cage, evenly grown to `tendon_share` of the area, and none of it is on the wall. No openings. Genus 0.
// Adds messages to `fallbacks`. FAILED_PRECONDITION, with what to label or check, if less than a twentieth of the sheet
// was observed, or if the rim does not enclose a sheet that can be meshed.
absl::StatusOr<DerivedDiaphragm> DeriveDiaphragm(const LabelVolume& volume, const std::vector<Part>& parts,
                                                 const CageFrame& frame, const FittedCage& cage,
                                                 const DiaphragmOptions& options, Fallbacks& fallbacks);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_DERIVED_DIAPHRAGM_H_
