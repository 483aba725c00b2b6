// Any bytes as landmarks give finite points, as many places at inhale as at exhale or none, or an error; in each
// format. Whatever is read is either divided into two lungs or refused.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "server/fit/read_landmarks.h"
#include "server/fit/sides.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  for (const char* name : {"fuzz.csv", "fuzz.fcsv", "fuzz.mrk.json"}) {
    const auto landmarks = phrenic::fit::ParseLandmarks(name, bytes);
    if (!landmarks.ok()) continue;
    const auto& [exhale, motion, labels, phase] = *landmarks;
    if (exhale.cols() == 0 || !exhale.allFinite() || !motion.allFinite()) std::abort();
    if (motion.cols() != 0 && motion.cols() != exhale.cols()) std::abort();
    if (phase.size() != 0 && (phase.size() != motion.cols() || !phase.allFinite())) std::abort();
    const auto sides = phrenic::fit::FindSides(exhale);
    if (sides.ok() && static_cast<Eigen::Index>(sides->of.size()) != exhale.cols()) std::abort();
  }
  return 0;
}
