// Any bytes as a DICOM file, such as a Segmentation or an RT Structure Set, or as an archive of label files, give a
// label volume with the stated number of voxels, and a meaning for numbers that are different, or an error.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <set>

#include "server/imaging/labels/label_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const auto input = phrenic::imaging::ParseLabelInput("fuzz.dcm", bytes, "");
  if (!input.ok()) return 0;
  const auto& volume = input->volume;
  const auto voxels = static_cast<std::size_t>(volume.size.x()) * volume.size.y() * volume.size.z();
  if (volume.labels.size() != voxels || !volume.to_patient.matrix().allFinite()) std::abort();
  std::set<int> numbers;
  for (const auto& label : input->meanings.labels()) {
    if (label.number() != 0 && !numbers.insert(label.number()).second) std::abort();
  }
  return 0;
}
