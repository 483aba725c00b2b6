// The diaphragm that no segmentation has: derived from what lies on either side of it.
#ifndef PHRENIC_SERVER_IMAGING_DERIVED_DIAPHRAGM_H_
#define PHRENIC_SERVER_IMAGING_DERIVED_DIAPHRAGM_H_

#include "absl/status/statusor.h"
#include "server/imaging/cage_frame.h"
#include "server/mesh/mesh.h"

namespace phrenic::imaging {

struct DiaphragmOptions {
  int vertices = 20000;        // aimed at, on both layers together
  double tendon_share = 0.22;  // of the sheet's area; 15-25 % in people
};

struct DerivedDiaphragm {
  Mesh
      mesh;  // [m], LPS: a closed double layer, 3 mm apart, with the regions "tendon", "rim", "crus-right", "crus-left"
  v1::DerivedDiaphragm report;
};

// The domes from the under side of lungs and heart against the upper side of liver, spleen and stomach; the zone of
// apposition from the inner face of ribs and cartilages; the crura along the lumbar vertebrae; smooth and, where
// nothing was seen, going on from around (SmoothSheet). The tendon is the part of the sheet that is furthest from the
// rim along the sheet, as large as the share says (automatic division, thesis 3.1). Without openings. Errors as
// FindCageFrame's.
absl::StatusOr<DerivedDiaphragm> DeriveDiaphragm(const LabelVolume& volume, const std::vector<Part>& parts,
                                                 const CageFrame& frame, const DiaphragmOptions& options,
                                                 Sentences& fallbacks);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_DERIVED_DIAPHRAGM_H_
