// Any bytes as an MSH file give a valid motion or an error.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "server/meshio/motion.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const auto motion = phrenic::meshio::ParseMotion("fuzz.msh", bytes, 0.001);
  if (!motion.ok()) return 0;
  if (!phrenic::Validate(motion->mesh).ok() || motion->times.size() != motion->displacements.size()) std::abort();
  for (const phrenic::Points& displacement : motion->displacements) {
    if (displacement.cols() != motion->mesh.vertices.cols() || !displacement.allFinite()) std::abort();
  }
  for (std::size_t i = 1; i < motion->times.size(); ++i) {
    if (!(motion->times[i] > motion->times[i - 1])) std::abort();
  }
  return 0;
}
