// Any bytes as an STL file give a valid mesh or an error.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "server/meshio/meshio.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const auto mesh = phrenic::meshio::Parse("fuzz.stl", bytes, 0.001);
  if (mesh.ok() && !phrenic::Validate(*mesh).ok()) std::abort();
  return 0;
}
