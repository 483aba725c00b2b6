// The parts of a thorax in a label volume: which voxels are the fifth left rib.
#ifndef PHRENIC_SERVER_IMAGING_PARTS_H_
#define PHRENIC_SERVER_IMAGING_PARTS_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "phrenic/v1/patient.pb.h"
#include "server/imaging/mask.h"

namespace phrenic::imaging {

struct Part {
  std::string name;     // of the body: "rib-5-left", "t12", else the label's
  v1::Anatomy anatomy;  // ribs with number and side; nothing for an organ
  v1::Organ organ = v1::ORGAN_UNSPECIFIED;
  Mask mask;  // cleaned, one piece, with room around for SurfaceOf
  std::size_t label_voxels = 0;

  bool Is(v1::Structure structure) const { return anatomy.structure() == structure; }
};

using Sentences = std::vector<std::string>;

// Each label of the map that the volume has, closed, without cavities, its largest piece. Cartilages in one label
// become a part a piece. Ribs in one label are taken apart, given to the side of the spine (else of the middle of all
// ribs) on which they lie, and numbered from the top by where their heads are. `fallbacks` gets a sentence for all that
// had to be guessed or was lost. FAILED_PRECONDITION where the volume has none of the map's labels.
absl::StatusOr<std::vector<Part>> FindParts(const LabelVolume& volume, const v1::LabelMap& map, Sentences& fallbacks);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_PARTS_H_
