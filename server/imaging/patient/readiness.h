// Judges whether a label volume shows enough of a thorax for its simulation to say something about the person.
#ifndef PHRENIC_SERVER_IMAGING_PATIENT_READINESS_H_
#define PHRENIC_SERVER_IMAGING_PATIENT_READINESS_H_

#include <vector>

#include "server/imaging/label_volume.h"
#include "server/imaging/patient/patient_body.h"
#include "server/imaging/segmented_parts.h"

namespace phrenic::imaging {

// Returns the findings, the gravest first, and the verdict, which is that of the gravest. Each finding says what was
// measured and what follows for the person's model:
//
//   cut lung            a lung that the border cuts over more than 2 cm^2; not usable above 20
//   cut ribs            ribs that the border cuts; not usable from 8
//   missing ribs        of ribs 1 to 10 of both sides, neither seen nor filled; not usable from 7
//   filled parts        from the template: never better than with care; not usable if the residual of its registration
//                       exceeds 15 mm
//   missing organs      heart, liver, or both stomach and spleen, unless the diaphragm has a label; not usable if all
//   extrapolated sheet  more than 25 % of the sheet; not usable above 50 %
//   axes of ribs        necks whose angle to the midsagittal plane is outside 25 to 90 degrees; not usable from a
//                       quarter
//   tower               a sheet whose middle fifth is higher than its domes; not usable above 15 mm
//   crossed sheet       a sheet that crosses itself at rest; not usable from 20 places
//   area                a sheet outside of 500 to 1,600 cm^2; adults have 700 to 1,300
//
// Requires: the report has ribs and diaphragm, and the bodies are moved to the midsagittal plane. Thread-safe.
v1::Readiness JudgeReadiness(const LabelVolume& volume, const std::vector<Part>& parts,
                             const std::vector<PatientBody>& bodies, const v1::PatientReport& report);

}  // namespace phrenic::imaging

#endif  // PHRENIC_SERVER_IMAGING_PATIENT_READINESS_H_
