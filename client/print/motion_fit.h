// Fits of people's breaths as tables, JSON and CSV. Lengths are in mm.
#ifndef PHRENIC_CLIENT_PRINT_MOTION_FIT_H_
#define PHRENIC_CLIENT_PRINT_MOTION_FIT_H_

#include <nlohmann/json.hpp>

#include "client/connection/context.h"
#include "server/fit/motion_study.h"
#include "server/fit/structures.h"

namespace phrenic::client {

// Distances from the person's structures, of the lungs as scaled, and as bent. Empty without structures.
struct StructureResiduals {
  std::vector<fit::StructureResidual> scaled, bent;
  std::array<double, 2> most = {};  // that each lung was bent by, by Side [m]
};
nlohmann::json RegistrationJson(const fit::RegisteredLungs& registered, const StructureResiduals& residuals = {});
void PrintStructures(const StructureResiduals& residuals);
void PrintRegistration(const fit::RegisteredLungs& registered);
void PrintRegistrationCsv(const fit::RegisteredLungs& registered);
// On standard error.
void PrintDoubts(const fit::RegisteredLungs& registered);

// The numbers of one fit; `options` are those it was made with.
nlohmann::json FitJson(const fit::MotionFit& fit, const fit::FitOptions& options);
void PrintFit(const fit::MotionFit& fit, const fit::FitOptions& options);
// The held-out errors beside those of plain models.
void PrintErrors(const fit::MotionFit& fit);
// Rows: kind, name, numbers, points, value, standard_error, spread, mean, p95.
void PrintFitCsv(const fit::MotionFit& fit);

// The motion expected for one number, over regions of the points.
struct Expected {
  fit::Prediction prediction;
  std::vector<Amplitude> amplitudes;
  std::vector<fit::RegionError> regions;  // motion and, as the error's mean, the spread between people
  int people = 0;                         // the prior is of
};
nlohmann::json ExpectedJson(const Expected& expected);
void PrintExpected(const Expected& expected);
void PrintExpectedCsv(const Expected& expected);

nlohmann::json StudyJson(const fit::MotionStudy& study);
// One row per person, and their mean.
void PrintMotionStudy(const fit::MotionStudy& study);
void PrintMotionStudyCsv(const fit::MotionStudy& study);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_PRINT_MOTION_FIT_H_
