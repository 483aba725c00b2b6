// Collects evidence for the sheet between thorax and abdomen by casting rays through the segmented volume.
#ifndef PHRENIC_SERVER_IMAGING_SHEET_EVIDENCE_H_
#define PHRENIC_SERVER_IMAGING_SHEET_EVIDENCE_H_

#include "server/imaging/fitted_cage.h"

namespace phrenic::imaging {

// What determined the sheet's depth: nothing, organs on both sides, an organ on one side, a bone, the diaphragm's own
// label, or the wall where there is no bone.
enum class Source { kNone, kBetween, kBesideOne, kOnBone, kLabel, kOnWall };

// A square grid of rays over |p.x|, |p.y| <= kPlaneReach.
struct SheetEvidence {
  int count = 0;  // along each axis
  std::vector<Source> source;
  std::vector<double> depth;  // of the sheet's middle surface, unless the source is kNone [mm]

  double cell() const { return 2 * kPlaneReach / (count - 1); }
  int Index(int i, int j) const { return j * count + i; }
  Eigen::Vector2d Plane(int i, int j) const {
    return Eigen::Vector2d(i, j) * cell() - Eigen::Vector2d::Constant(kPlaneReach);
  }
};

// Casts each ray outwards to the first voxel of lung, heart or bone, or through the diaphragm if it has a label. The
// depth of the middle surface is then
//   kLabel:     the middle of the labelled diaphragm;
//   kBetween:   halfway between an abdominal organ and lung or heart at most 14 mm apart;
//   kBesideOne: 3.5 mm below a lung or the heart with no organ near below it;
//   kOnBone:    on the wall, if the ray is horizontal; else 4 mm inside a bone's inner face;
//   kOnWall:    on the wall, where a horizontal ray meets nothing.
// If the diaphragm has a label, a ray that does not meet it passes through an opening and counts as meeting nothing.
// Of the vertebrae only T11 and below count, of sternum and cartilages only the part near the sternum's lower end;
// above, the mediastinum lies between.
SheetEvidence CollectEvidence(const LabelVolume& volume, const std::vector<Part>& parts, const CageFrame& frame,
                              const FittedCage& cage);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_SHEET_EVIDENCE_H_
