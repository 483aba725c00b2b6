// Any bytes as a DICOM file give a label volume with the stated number of voxels, or an error.
#include "server/imaging/dicom_segmentation.h"

#include <cstddef>
#include <cstdint>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const auto volume = phrenic::imaging::ParseDicomSegmentation("fuzz.dcm", bytes);
  if (!volume.ok()) return 0;
  const auto voxels = static_cast<std::size_t>(volume->size.x()) * volume->size.y() * volume->size.z();
  if (volume->labels.size() != voxels || !volume->to_patient.matrix().allFinite()) std::abort();
  return 0;
}
