// The scene of a patient's thorax.
#ifndef PHRENIC_SERVER_IMAGING_PATIENT_SCENE_H_
#define PHRENIC_SERVER_IMAGING_PATIENT_SCENE_H_

#include "server/imaging/patient.h"

namespace phrenic::imaging {

// The cage's width over that of the generated thorax, for which the pattern's forces are made.
double ScaleOf(const CageFrame& frame);

// The pattern with the patient's bodies in its layers. Each rib turns about the horizontal part of its own neck's axis
// by the angle that the pattern has for its number (the scene language's rotation: pump and bucket); cartilages ride on
// ribs and sternum, lungs as in the pattern. Action lines go down through the two domes, midway between front and back;
// lengths are scaled by ScaleOf, forces by the root of the sheet's area, and some by constants of the derived sheet
// (patient_scene.cc). What names a layer that the patient has not is left out.
v1::Scene PatientScene(const v1::Scene& pattern, const std::vector<PatientBody>& bodies, const CageFrame& frame,
                       const std::string& name);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_PATIENT_SCENE_H_
