// Any bytes as a file of a person, of the kind that the first byte chooses, give data within their bounds, or an error.
// As a kept fit they give one whose parts belong together, or nothing.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "server/fit/evidence.h"
#include "server/fit/kept_fit.h"

namespace {

using phrenic::fit::Evidence;

void MustHold(bool condition) {
  if (!condition) std::abort();
}

void CheckLandmarks(const phrenic::fit::Landmarks& landmarks) {
  MustHold(landmarks.motion.cols() == landmarks.size() && landmarks.phase.size() == landmarks.size());
  MustHold(landmarks.exhale.allFinite() && landmarks.motion.allFinite() && landmarks.phase.allFinite());
}

void CheckTrace(const phrenic::fit::TracedBreaths& breaths) {
  MustHold(breaths.phase.size() > 0 && breaths.phase.size() == breaths.value.size());
  MustHold(breaths.value.allFinite() && breaths.lengths.minCoeff() > 0);
  MustHold(breaths.phase.minCoeff() >= 0 && breaths.phase.maxCoeff() <= 1);
  MustHold(breaths.breath.size() == breaths.phase.size() && breaths.breath.minCoeff() >= 0);
  MustHold(breaths.breath.maxCoeff() < breaths.lengths.size());
  const auto samples = SamplesOf(breaths, false).size() + SamplesOf(breaths, true).size();
  MustHold(samples == static_cast<std::size_t>(breaths.phase.size()) && !SamplesOf(breaths, false).empty());
}

void CheckMarkers(const phrenic::fit::Markers& markers) {
  const auto count = static_cast<std::size_t>(markers.rest.cols());
  MustHold(count >= 3 && markers.names.size() == count && markers.motion.cols() == markers.rest.cols());
  MustHold(markers.rest.allFinite() && markers.motion.allFinite());
}

void CheckEvidence(const Evidence& evidence) {
  CheckLandmarks(evidence.landmarks);
  MustHold(evidence.exhale.allFinite());
  for (const Evidence::SurfaceFile& file : evidence.surfaces) {
    MustHold(file.kind.sd > 0 && file.surfaces.inhale.vertices.allFinite());
  }
  for (const Evidence::TraceFile& file : evidence.traces) CheckTrace(file.breaths);
  for (const Evidence::MarkerFile& file : evidence.markers) CheckMarkers(file.markers);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  constexpr int kKept = 7;
  const int kind = data[0] % 8;
  const std::string bytes(reinterpret_cast<const char*>(data) + 2, size - 2);
  if (kind == kKept) {
    const auto fit = phrenic::fit::ReadKeptFit(bytes);
    MustHold(!fit || phrenic::fit::KeepFit(*fit).size() == bytes.size());
    return 0;
  }
  constexpr const char* kNames[] = {"a.csv", "a.csv", "a.stl", "a.obj", "a.csv", "a.csv", "a.csv"};
  phrenic::fit::MeasuredFile file;
  file.measured = static_cast<phrenic::fit::Measured>(kind);
  file.name = kNames[kind];
  file.bytes = bytes;
  if ((data[1] & 1) != 0) file.error = data[1] / 10.0;
  const auto evidence = phrenic::fit::ParseEvidence({file});
  if (evidence.ok()) CheckEvidence(*evidence);
  return 0;
}
