// A body of a patient's thorax.
#ifndef PHRENIC_SERVER_IMAGING_PATIENT_PATIENT_BODY_H_
#define PHRENIC_SERVER_IMAGING_PATIENT_PATIENT_BODY_H_

#include <string>

#include "phrenic/v1/scene.pb.h"
#include "server/mesh/mesh.h"

namespace phrenic::imaging {

struct PatientBody {
  std::string name;
  v1::Anatomy anatomy;
  Mesh mesh;  // [m], LPS, the midsagittal plane at x = 0
};

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_PATIENT_PATIENT_BODY_H_
