// Any bytes as a recording give phases in a breath, finite values and positive lengths, or an error.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "server/fit/traces.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  for (const auto traced : {phrenic::fit::Traced::kVolume, phrenic::fit::Traced::kDisplacement}) {
    const auto breaths = phrenic::fit::ParseTrace(traced, "fuzz.csv", bytes);
    if (!breaths.ok()) continue;
    if (breaths->phase.size() == 0 || breaths->phase.size() != breaths->value.size()) std::abort();
    if (!breaths->value.allFinite() || !(breaths->lengths.minCoeff() > 0)) std::abort();
    if (!(breaths->phase.minCoeff() >= 0) || !(breaths->phase.maxCoeff() <= 1)) std::abort();
  }
  return 0;
}
