// Markers on a person's chest, in any frame, against the ribs and the sternum of a simulated breath.
//
// Markers that are named after bones of the scene ("rib-7-right", "rib-7-right front", "sternum-body upper") lie over
// these. A similarity (turn, shift, one scale) moves them onto the bones, each towards the nearest point of its own:
// the scale allows for the person's size and for the skin over the bones. The other markers follow, and belong to the
// nearest bone. What is compared is the motion along the outward normal of the chest's wall, in the person's
// millimetres, less a shift of the body (0 +- 5 mm along each axis).
#ifndef PHRENIC_SERVER_CALIBRATE_CAGE_MARKERS_H_
#define PHRENIC_SERVER_CALIBRATE_CAGE_MARKERS_H_

#include <Eigen/Geometry>

#include "server/calibrate/breath_data.h"

namespace phrenic::calibrate {

inline constexpr int kFewestNamedMarkers = 4;

struct CageRegistration {
  Eigen::Affine3d to_scene;          // of the markers' places
  double scale = 1, rms = 0;         // [1]; of the named markers' distances from their bones [m], in the scene
  int named = 0;                     // markers
  std::vector<int> bones, vertices;  // of each marker: the body, and its vertex that is nearest
  Points normals;                    // of each marker: outward, in the scene
};

// INVALID_ARGUMENT if fewer than kFewestNamedMarkers are named after bones, or lie over fewer than three, or almost on
// a line; if their scale is not that of a chest (0.6 to 1.6: another unit), if they are the mirror image of a chest (a
// wrong axis), or lie more than 25 mm from the bones on average (root mean square). FAILED_PRECONDITION for a scene
// without ribs and an inner wall of the cage.
absl::StatusOr<CageRegistration> RegisterToCage(const physiology::Subject& subject, const std::string& source,
                                                const fit::Markers& markers);

// Of 8 markers or more every fourth is held out. The errors of RegisterToCage. Refers to the subject.
absl::StatusOr<std::unique_ptr<BreathData>> CageData(const physiology::Subject& subject,
                                                     const fit::Evidence::MarkerFile& file);

}  // namespace phrenic::calibrate

#endif  // PHRENIC_SERVER_CALIBRATE_CAGE_MARKERS_H_
