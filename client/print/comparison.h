// The result of `phrenic compare`: as a table, as CSV, and checked against limits.
#ifndef PHRENIC_CLIENT_PRINT_COMPARISON_H_
#define PHRENIC_CLIENT_PRINT_COMPARISON_H_

#include <ostream>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "phrenic/v1/compare.pb.h"

namespace phrenic::client {

// A limit of a measure of SurfaceDistance: at most `value` in the measure's unit, or at least `value` if more is better
// (surface_dice). Of an option --check.
struct Limit {
  const google::protobuf::FieldDescriptor* measure = nullptr;  // of the schema, never null after ReadLimits
  double value = 0;
};

// Parses texts such as "hd95_max=2". INVALID_ARGUMENT quotes the text and lists the measures. Limits keep the order of
// `texts`. A number must be finite.
absl::StatusOr<std::vector<Limit>> ReadLimits(const std::vector<std::string>& texts);

// Returns a sentence for each limit that the whole surfaces, over all times, do not meet. NaN meets no limit. Compares
// the first row of the table; without rows, nothing meets a limit.
std::vector<std::string> MissedLimits(const v1::ComparisonTable& table, const std::vector<Limit>& limits);

// Prints the measures of each region [mm], the baseline beside them, and one row per time of a motion.
void PrintComparison(const v1::ComparisonTable& table, std::ostream& out);
// Prints a header and one line per row. The baseline's measures, if any, follow the others. Nine digits, in the units
// of the schema; a row of all times has no time.
void PrintComparisonCsv(const v1::ComparisonTable& table, std::ostream& out);

// Returns the help text of every measure, from the schema. For `phrenic compare --help`.
std::string MeasureHelp();

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_PRINT_COMPARISON_H_
