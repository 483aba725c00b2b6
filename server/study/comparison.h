// Two surfaces, or two motions, compared: whole, by region and by time.
#ifndef PHRENIC_SERVER_STUDY_COMPARISON_H_
#define PHRENIC_SERVER_STUDY_COMPARISON_H_

#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "phrenic/v1/compare.pb.h"
#include "server/record/recorder.h"

namespace phrenic::study {

// Compares as compare.proto says; `request` has been validated. A triangle belongs to a region when its three vertices
// do. `progress` is told how much is done, 0 to 1; CANCELLED as soon as it returns false. Where a map is asked for its
// file goes to `map`. INVALID_ARGUMENT "name:line: ..." for a file that cannot be read, or naming the field;
// FAILED_PRECONDITION for motions that share no time.
absl::StatusOr<v1::ComparisonTable> Compare(const v1::CompareRequest& request, absl::FunctionRef<bool(double)> progress,
                                            const record::Sink& map);

// One distance for several times: of rms_* the root of the mean square, of hd*, p95* and spacing_* the largest, of the
// other measures the mean; samples are added up. NaN where one of them is NaN.
v1::SurfaceDistance OverTimes(const std::vector<v1::SurfaceDistance>& distances);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_COMPARISON_H_
