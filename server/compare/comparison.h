// Two surfaces, or two motions, compared: whole, by region and by time.
#ifndef PHRENIC_SERVER_COMPARE_COMPARISON_H_
#define PHRENIC_SERVER_COMPARE_COMPARISON_H_

#include <functional>
#include <vector>

#include "absl/status/statusor.h"
#include "phrenic/v1/compare.pb.h"
#include "server/compare/compared.h"
#include "server/record/recorder.h"

namespace phrenic::compare {

// Where a comparison goes as it is made. An error of a call ends it and becomes its own.
struct ComparisonSink {
  std::function<bool(double)> progress;  // how much is done, 0 to 1; false: CANCELLED
  std::function<absl::Status(const v1::VertexDistances&)> vertices;
  record::Sink map;                                                             // the next bytes of the map's file
  std::function<absl::Status(ConstPoints x, const Triangles& triangles)> mesh;  // B's [m]
};

// Compares as compare.proto says; `request` has been validated. A triangle belongs to a region when its three vertices
// do. Errors are ReadPair's; INVALID_ARGUMENT too for a surface without triangles whose vertices are asked for.
absl::StatusOr<v1::ComparisonTable> Compare(const v1::CompareRequest& request, BodySource bodies,
                                            const ComparisonSink& sink);

// One distance for several times: of rms_* the root of the mean square, of hd*, p95* and spacing_* the largest, of the
// other measures the mean; samples are added up. NaN where one of them is NaN.
v1::SurfaceDistance OverTimes(const std::vector<v1::SurfaceDistance>& distances);

}  // namespace phrenic::compare

#endif  // PHRENIC_SERVER_COMPARE_COMPARISON_H_
