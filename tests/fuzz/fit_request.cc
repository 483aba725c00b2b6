// Any bytes as a FitMotionRequest or a StudyMotionRequest give landmarks within the limits and valid options, or an
// error.
#include "server/fit/fit_request.h"

#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "server/schema/schema.h"

namespace {

void CheckStudy(const std::uint8_t* data, std::size_t size) {
  phrenic::v1::StudyMotionRequest request;
  if (!request.ParseFromArray(data, static_cast<int>(size)) || !phrenic::schema::Validate(request).ok()) return;
  const auto requested = phrenic::fit::ReadStudyRequest(request);
  if (!requested.ok()) return;
  if (requested->cases.empty() || requested->cases.size() > phrenic::fit::kMostCases) std::abort();
  Eigen::Index pairs = 0;
  for (const auto& each : requested->cases) {
    pairs += each.landmarks.size();
    if (each.name.empty() || !each.landmarks.exhale.allFinite() || !each.landmarks.motion.allFinite()) std::abort();
  }
  if (pairs > phrenic::fit::kMostStudyPairs) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  CheckStudy(data, size);
  phrenic::v1::FitMotionRequest request;
  if (!request.ParseFromArray(data, static_cast<int>(size)) || !phrenic::schema::Validate(request).ok()) return 0;
  const auto requested = phrenic::fit::ReadFitRequest(request);
  if (!requested.ok()) return 0;
  if (requested->evidence) {
    if (requested->evidence->landmarks.size() > phrenic::fit::kMostPairs || requested->source.empty()) std::abort();
    return 0;
  }
  const auto& landmarks = requested->landmarks;
  if (landmarks.size() == 0 || landmarks.size() > phrenic::fit::kMostPairs) std::abort();
  if (!landmarks.exhale.allFinite() || !landmarks.motion.allFinite()) std::abort();
  if (requested->options.numbers != 8 && requested->options.numbers != 12) std::abort();
  if (requested->scene_name.empty() || requested->source.empty()) std::abort();
  return 0;
}
