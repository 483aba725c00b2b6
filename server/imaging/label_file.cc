#include "server/imaging/label_file.h"

#include <filesystem>
#include <optional>
#include <system_error>

#include "absl/strings/str_cat.h"
#include "server/imaging/dicom_file.h"
#include "server/imaging/dicom_segmentation.h"
#include "server/imaging/gzip.h"
#include "server/imaging/nifti.h"
#include "server/imaging/nifti_header.h"
#include "server/schema/file_bytes.h"

namespace phrenic::imaging {

absl::StatusOr<LabelVolume> ParseLabels(std::string_view name, std::string_view bytes, std::size_t max_voxels) {
  return IsDicom(bytes) ? ParseDicomSegmentation(name, bytes, max_voxels) : ParseNifti(name, bytes, max_voxels);
}

absl::Status CheckLabelFormat(std::string_view name, std::string_view bytes) {
  if (IsDicom(bytes)) return absl::OkStatus();
  if (!IsGzip(bytes)) return ParseNiftiHeader(name, bytes).status();
  const absl::StatusOr<std::string> start = Inflate(name, bytes, kMaxHeader);
  return start.ok() ? ParseNiftiHeader(name, *start).status() : start.status();
}

bool IsLabelFile(std::string_view bytes) {
  constexpr std::size_t kHead = 2048;  // its meta information, which names the class, is at its start [bytes]
  if (!IsDicom(bytes)) return CheckLabelFormat("", bytes).ok();
  const std::string_view head = bytes.substr(0, kHead);
  const std::string start = "1.2.840.10008.5.1.4.1.1.";  // of storage classes (PS3.4, B.5)
  for (const char* ending : {"66.4", "66.7", "481.3"}) {
    const std::string name = absl::StrCat(start, ending);
    const std::size_t at = head.find(name);
    if (at == std::string_view::npos || at + name.size() >= head.size()) continue;
    if (const char next = head[at + name.size()]; next == '\0' || next == '\x02' || next == ' ') return true;
  }
  return false;
}

absl::StatusOr<LabelVolume> ReadLabels(const std::string& path) {
  const std::optional<std::string> bytes = ReadBytes(path);
  if (bytes.has_value()) return ParseLabels(path, *bytes);
  std::error_code error;
  const bool folder = std::filesystem::is_directory(path, error);
  return absl::NotFoundError(
      absl::StrCat("cannot read the label volume ", path,
                   folder ? ": it is a folder; name the file of the segmentation in it" : "; check the path"));
}

}  // namespace phrenic::imaging
