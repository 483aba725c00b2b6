// Any bytes as markers give as many finite places as motions and names, or an error.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "server/fit/markers.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto markers =
      phrenic::fit::ParseMarkers("fuzz.csv", std::string_view(reinterpret_cast<const char*>(data), size));
  if (!markers.ok()) return 0;
  const auto count = static_cast<std::size_t>(markers->rest.cols());
  if (count < 3 || markers->names.size() != count || markers->motion.cols() != markers->rest.cols()) std::abort();
  if (!markers->rest.allFinite() || !markers->motion.allFinite()) std::abort();
  return 0;
}
