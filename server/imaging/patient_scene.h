// Builds the scene of a patient's thorax from a pattern scene.
#ifndef PHRENIC_SERVER_IMAGING_PATIENT_SCENE_H_
#define PHRENIC_SERVER_IMAGING_PATIENT_SCENE_H_

#include <string>
#include <vector>

#include "server/imaging/cage_frame.h"
#include "server/imaging/patient_body.h"

namespace phrenic::imaging {

// Returns the width of the cage relative to the generated thorax, for which the pattern is tuned.
double ScaleOf(const CageFrame& frame);

// Returns the pattern with the patient's bodies in its layers. Each rib rotates about the horizontal component of its
// own neck axis by the pattern's angle for its number (pump and bucket rotation); cartilages are skinned to ribs and
// sternum, lungs as in the pattern. Action lines point down through the two domes, midway between front and back.
// Lengths are scaled by ScaleOf, forces by the square root of the sheet's area, and some by constants of the derived
// sheet (see patient_scene.cc). Elements of layers that the patient does not have are left out.
v1::Scene PatientScene(const v1::Scene& pattern, const std::vector<PatientBody>& bodies, const CageFrame& frame,
                       const std::string& name);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_PATIENT_SCENE_H_
