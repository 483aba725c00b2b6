// Builds the scene of a patient's thorax from a pattern scene.
#ifndef PHRENIC_SERVER_IMAGING_PATIENT_PATIENT_SCENE_H_
#define PHRENIC_SERVER_IMAGING_PATIENT_PATIENT_SCENE_H_

#include <string>
#include <vector>

#include "server/imaging/cage_frame.h"
#include "server/imaging/patient/patient_body.h"

namespace phrenic::imaging {

// Names of the bodies that are derived for mechanics, as in the pattern.
inline constexpr char kSheetBody[] = "diaphragm", kMiddleBody[] = "diaphragm-middle", kWallBody[] = "chest-wall";

// Returns the width of the cage relative to the generated thorax, to which the pattern belongs.
double ScaleOf(const CageFrame& frame);

// Returns the pattern, the scene `thorax`, with the patient's bodies in its layers. Bodies of the pattern with a
// patient's body of the same name keep all but their shape. Each rib rotates by the pattern's angle for its
// number, about the pattern's axis turned in the horizontal plane as far as the neck differs from that of the generated
// rib, moved by the two coordinates of the cage
// that all share; cartilages are skinned to ribs and sternum, the wall, the lungs and the seen diaphragm as in the
// pattern. Pressures are those of the pattern; the muscle's thickness,
// tensions and stiffnesses are multiplied by ScaleOf; volumes, compliances and inverse resistances are multiplied
// by the volume inside the wall relative to the generated one, the simulated mass by the square of ScaleOf. Elements of
// layers that the patient does not have are left out.
v1::Scene PatientScene(const v1::Scene& pattern, const std::vector<PatientBody>& bodies, const CageFrame& frame,
                       const std::string& name);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_PATIENT_PATIENT_SCENE_H_
