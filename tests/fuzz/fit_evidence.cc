// Any bytes as a person's files, of the kinds that the first byte chooses, give evidence within its bounds, or an
// error.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "server/fit/evidence.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  using phrenic::fit::Measured;
  constexpr const char* kNames[] = {"fuzz.csv", "fuzz.csv", "fuzz.stl", "fuzz.obj", "fuzz.csv", "fuzz.csv", "fuzz.csv"};
  phrenic::fit::MeasuredFile file;
  file.measured = static_cast<Measured>(data[0] % 7);
  file.name = kNames[data[0] % 7];
  file.bytes.assign(reinterpret_cast<const char*>(data) + 2, size - 2);
  if ((data[1] & 1) != 0) file.error = data[1] / 10.0;
  const auto evidence = phrenic::fit::ParseEvidence({file});
  if (!evidence.ok()) return 0;
  const auto& landmarks = evidence->landmarks;
  if (landmarks.motion.cols() != landmarks.size() || landmarks.phase.size() != landmarks.size()) std::abort();
  if (!landmarks.exhale.allFinite() || !landmarks.motion.allFinite() || !landmarks.phase.allFinite()) std::abort();
  for (const auto& surface : evidence->surfaces) {
    if (!(surface.kind.sd > 0) || !surface.surfaces.inhale.vertices.allFinite()) std::abort();
  }
  return 0;
}
