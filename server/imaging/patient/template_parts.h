// Fills missing parts of a thorax in a label volume from the generated thorax, the template.
#ifndef PHRENIC_SERVER_IMAGING_PATIENT_TEMPLATE_PARTS_H_
#define PHRENIC_SERVER_IMAGING_PATIENT_TEMPLATE_PARTS_H_

#include <vector>

#include "phrenic/v1/patient.pb.h"
#include "server/imaging/patient/template_fit.h"

namespace phrenic::imaging {

// Name of the region of vertices that are not the person's but the template's.
inline constexpr char kFromTemplate[] = "from-template";

// The parts of a thorax in a volume that holds all of them.
struct FilledParts {
  LabelVolume volume;       // the grid alone, grown if parts lie outside of it: no voxel has a label
  std::vector<Part> parts;  // those that were seen, then those from the template (Part::filled)
  v1::TemplateFill report;
};

// Adds the template's ribs 1 to 12 and lungs that are missing; vertebrae T1 to L3 if there are none; sternum and
// cartilages if there are none and fewer than half of the ribs are seen; and the heart if it has no label and the
// diaphragm has none. Bones lie where FitTemplate puts them; of lungs and heart, what is seen of other parts is taken
// away, and the largest component is kept. Nothing is filled, and the report says why, if the template cannot be
// registered. `fit`, if not null, replaces the registration. Thread-safe.
FilledParts FillFromTemplate(const LabelVolume& volume, std::vector<Part> parts, const TemplateFit* fit = nullptr);

// Adds the region kFromTemplate to a sheet [m]: its vertices within 15 mm of a filled part that are nearer to it than
// to any part that was seen. Returns their share of the vertices [1]. Thread-safe.
double MarkFilled(const FilledParts& filled, Mesh& sheet);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_PATIENT_TEMPLATE_PARTS_H_
