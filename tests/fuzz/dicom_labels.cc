// Any bytes as a DICOM file, such as a Segmentation or an RT Structure Set, give a label volume with the stated number
// of voxels, or an error.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "server/imaging/label_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const auto volume = phrenic::imaging::ParseLabels("fuzz.dcm", bytes);
  if (!volume.ok()) return 0;
  const auto voxels = static_cast<std::size_t>(volume->size.x()) * volume->size.y() * volume->size.z();
  if (volume->labels.size() != voxels || !volume->to_patient.matrix().allFinite()) std::abort();
  return 0;
}
