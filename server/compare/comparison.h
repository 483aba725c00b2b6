// Compares two surfaces or two motions: as a whole, by region and by time.
#ifndef PHRENIC_SERVER_COMPARE_COMPARISON_H_
#define PHRENIC_SERVER_COMPARE_COMPARISON_H_

#include <functional>
#include <vector>

#include "absl/status/statusor.h"
#include "phrenic/v1/compare.pb.h"
#include "server/compare/compared.h"
#include "server/record/recorder.h"

namespace phrenic::compare {

// Receives the results of a comparison while it runs. An error of a callback ends the comparison and is returned.
struct ComparisonSink {
  std::function<bool(double)> progress;  // gets the completed fraction, 0 to 1; cancels by returning false
  std::function<absl::Status(const v1::VertexDistances&)> vertices;             // once per time
  record::Sink map;                                                             // the next bytes of the map's file
  std::function<absl::Status(ConstPoints x, const Triangles& triangles)> mesh;  // B, x 3 x n [m]
};

// Compares two surfaces as compare.proto defines. Requires: `request` is validated. A triangle belongs to a region if
// its three vertices do. Errors: those of ReadPair and MatchTimes; INVALID_ARGUMENT if vertex distances are requested
// of a surface without triangles; CANCELLED if `progress` returns false. Uses two threads (MeasureDistance).
absl::StatusOr<v1::ComparisonTable> Compare(const v1::CompareRequest& request, BodySource bodies,
                                            const ComparisonSink& sink);

// Aggregates distances over times: rms_* by the root of the mean square; hd*, p95* and spacing_* by the maximum; the
// other measures by the mean; sample counts by the sum. A measure is NaN if any of its inputs is NaN.
v1::SurfaceDistance OverTimes(const std::vector<v1::SurfaceDistance>& distances);

}  // namespace phrenic::compare

#endif  // PHRENIC_SERVER_COMPARE_COMPARISON_H_
