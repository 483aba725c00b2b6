// Segments a label volume into the parts of a thorax, each with its anatomical identity and mask.
#ifndef PHRENIC_SERVER_IMAGING_SEGMENTED_PARTS_H_
#define PHRENIC_SERVER_IMAGING_SEGMENTED_PARTS_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "phrenic/v1/patient.pb.h"
#include "server/imaging/mask.h"
#include "server/mesh/mesh.h"

namespace phrenic::imaging {

struct Part {
  std::string name;     // body name: "rib-5-left", "t12", else the label's name
  v1::Anatomy anatomy;  // ribs have number and side; unset for an organ
  v1::Organ organ = v1::ORGAN_UNSPECIFIED;
  Mask mask;                     // closed, connected, with SurfaceMargin
  std::size_t label_voxels = 0;  // before closing
  bool filled = false;           // not in the volume: the template's (patient/template_parts.h)
  Mesh surface = {};             // of a filled bone [m]; else it is made from the mask

  bool Is(v1::Structure structure) const { return anatomy.structure() == structure; }
};

// What the volume does not define, and what is done instead.
struct Fallback {
  std::string text;  // a sentence in English
  v1::AssumptionKind kind = v1::ASSUMPTION_KIND_UNSPECIFIED;
  std::vector<std::string> parts = {};  // by `kind`
  std::vector<double> values = {};      // by `kind`
};
using Fallbacks = std::vector<Fallback>;

// Returns a part for each label of the map in the volume: closed, without cavities, the largest component. Cartilages
// in one label become one part per component. Ribs in one label are divided into components, assigned to a side of the
// spine (else of the ribs' mean), and numbered from the top by the height of their heads. Adds a message to `fallbacks`
// for everything guessed or lost. FAILED_PRECONDITION if the volume has none of the map's labels.
absl::StatusOr<std::vector<Part>> FindParts(const LabelVolume& volume, const v1::LabelMap& map, Fallbacks& fallbacks);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_SEGMENTED_PARTS_H_
