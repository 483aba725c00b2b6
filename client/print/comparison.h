// What a comparison of surfaces says: as a table, as CSV, and against limits.
#ifndef PHRENIC_CLIENT_PRINT_COMPARISON_H_
#define PHRENIC_CLIENT_PRINT_COMPARISON_H_

#include <ostream>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "phrenic/v1/compare.pb.h"

namespace phrenic::client {

// A measure of SurfaceDistance and what it may be: at most `value`, or at least where more is better (surface_dice).
struct Limit {
  const google::protobuf::FieldDescriptor* measure = nullptr;
  double value = 0;
};

// Reads "hd95_max=2" and the like; INVALID_ARGUMENT names the measures there are.
absl::StatusOr<std::vector<Limit>> ReadLimits(const std::vector<std::string>& texts);

// A sentence for each limit that the whole surfaces, over all times, do not keep; NaN keeps none.
std::vector<std::string> MissedLimits(const v1::ComparisonTable& table, const std::vector<Limit>& limits);

void PrintComparison(const v1::ComparisonTable& table, std::ostream& out);
// One line a row, with a head; the baseline's measures after the others where there is one.
void PrintComparisonCsv(const v1::ComparisonTable& table, std::ostream& out);

// Every measure with its unit and meaning, and the meaning of one field of the request, as the schema has them.
std::string MeasureHelp();
std::string FieldHelp(const google::protobuf::Descriptor& message, const std::string& field);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_PRINT_COMPARISON_H_
