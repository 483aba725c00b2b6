// Any bytes as a kept fit give a fit whose parts belong together, which is kept as the same bytes, or nothing.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "server/fit/kept_fit.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto fit = phrenic::fit::ReadKeptFit(std::string_view(reinterpret_cast<const char*>(data), size));
  if (fit && phrenic::fit::KeepFit(*fit).size() != size) std::abort();
  return 0;
}
