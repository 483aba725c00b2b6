// Any bytes as scene text give a scene that stays valid with defaults and after serialization, or an error.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "server/schema/schema.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  auto scene = phrenic::schema::ParseScene("fuzz", text);
  if (!scene.ok()) {
    if (scene.status().message().substr(0, 5) != "fuzz:") std::abort();
    return 0;
  }
  phrenic::v1::Scene again;
  if (!again.ParseFromString(scene->SerializeAsString())) std::abort();
  phrenic::schema::FillDefaults(&*scene);
  if (!phrenic::schema::Validate(*scene).ok()) std::abort();
  return 0;
}
