// Where the sheet between thorax and abdomen was seen along each ray of the cage's frame.
#ifndef PHRENIC_SERVER_IMAGING_SHEET_EVIDENCE_H_
#define PHRENIC_SERVER_IMAGING_SHEET_EVIDENCE_H_

#include "server/imaging/cage_frame.h"

namespace phrenic::imaging {

enum class Sight { kNone, kBetween, kBesideOne, kOnBone, kLabel };

// A square grid of rays over |p.x|, |p.y| <= kPlaneReach.
struct SheetEvidence {
  int count = 0;  // along an edge
  std::vector<Sight> sight;
  std::vector<double> depth;  // of the sheet's middle where something was seen [mm]

  double cell() const { return 2 * kPlaneReach / (count - 1); }
  int Index(int i, int j) const { return j * count + i; }
  Eigen::Vector2d Plane(int i, int j) const {
    return Eigen::Vector2d(i, j) * cell() - Eigen::Vector2d::Constant(kPlaneReach);
  }
};

// Follows each ray outwards to the first voxel of lung, heart or bone, or of the diaphragm where it has a label: then
// its middle counts. Else the sheet's middle is halfway between an abdominal organ and lung or heart where they are
// near each other, 3.5 mm below a lung or heart that has nothing near below it, 4 mm inside a bone's inner face.
// Vertebrae count from T11 down, sternum and cartilages near the sternum's end: above, the mediastinum lies between.
SheetEvidence Look(const LabelVolume& volume, const std::vector<Part>& parts, const CageFrame& frame);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_SHEET_EVIDENCE_H_
