// Fits to several kinds of a person's data as tables, JSON and CSV.
#ifndef PHRENIC_CLIENT_PRINT_JOINT_FIT_H_
#define PHRENIC_CLIENT_PRINT_JOINT_FIT_H_

#include <nlohmann/json.hpp>

#include "server/fit/joint_fit.h"

namespace phrenic::client {

// The fields of FitJson that there are, and "fitted", "derived", "kinds" and "own_lungs". `options` are those of the
// fit.
nlohmann::json JointFitJson(const fit::JointFit& fit, const fit::FitOptions& options);
void PrintJointFit(const fit::JointFit& fit, const fit::FitOptions& options);
// The same of numbers, what follows from them, and kinds, wherever they were fitted.
nlohmann::json FittedJson(const std::vector<fit::FittedQuantity>& numbers,
                          const std::vector<fit::FittedQuantity>& derived, const std::vector<fit::KindReport>& kinds);
void PrintFitted(const std::vector<fit::FittedQuantity>& numbers, const std::vector<fit::FittedQuantity>& derived,
                 const std::vector<fit::KindReport>& kinds);
void PrintFittedCsv(const std::vector<fit::FittedQuantity>& numbers, const std::vector<fit::FittedQuantity>& derived,
                    const std::vector<fit::KindReport>& kinds, const std::vector<fit::Baseline>& baselines);
// Rows: kind, name, unit, data, value, standard_error, prior, prior_sd, still, before, after, held_out.
void PrintJointFitCsv(const fit::JointFit& fit);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_PRINT_JOINT_FIT_H_
