// Any bytes as a kept mesh give a valid mesh, which is packed to the same bytes, or none; and so do any bytes behind
// their right checksum.
#include "server/session/mesh_cache/mesh_cache.h"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "server/crypto/sha256.h"

namespace {

void CheckPacked(const std::string& bytes) {
  const auto mesh = phrenic::session::UnpackMesh(bytes);
  if (!mesh.has_value()) return;
  if (!phrenic::Validate(*mesh).ok() || phrenic::session::PackMesh(*mesh) != bytes) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  CheckPacked(bytes);
  CheckPacked(phrenic::Sha256Hex(bytes) + bytes);
  return 0;
}
