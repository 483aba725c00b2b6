// Percentiles and spread of a sample. Stateless; thread-safe.
#ifndef PHRENIC_SERVER_STUDY_UNCERTAINTY_PERCENTILES_H_
#define PHRENIC_SERVER_STUDY_UNCERTAINTY_PERCENTILES_H_

#include <vector>

namespace phrenic::study {

// Returns the percentile, `percent` within 0 to 100, linearly between two values of the sorted sample (type 7 of
// Hyndman and Fan); NaN of no values. Requires: all are finite.
double Percentile(std::vector<double> values, double percent);

// Returns the sample standard deviation, with n - 1; 0 of less than two values.
double DeviationOf(const std::vector<double>& values);

// True if a variance is more than rounding of values of that mean.
bool Varies(double variance, double mean);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_UNCERTAINTY_PERCENTILES_H_
