#include "server/imaging/label_file.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "server/imaging/dicom_file.h"
#include "server/imaging/dicom_segmentation.h"
#include "server/imaging/gzip.h"
#include "server/imaging/nifti.h"
#include "server/imaging/nifti_header.h"
#include "server/schema/file_bytes.h"

namespace phrenic::imaging {

namespace {

constexpr std::size_t kTarMark = 257, kTarHead = 512;  // byte at which "ustar" is; length of a tar header
constexpr std::size_t kLongestEnding = 7;              // length of ".nii.gz"

// True for a DICOM Segmentation, a Label Map Segmentation or an RT Structure Set.
bool HasLabelClass(std::string_view dicom) {
  constexpr std::size_t kHead = 2048;  // its meta information, which names the class, is at its start [bytes]
  const std::string_view head = dicom.substr(0, kHead);
  const std::string start = "1.2.840.10008.5.1.4.1.1.";  // of storage classes (PS3.4, B.5)
  for (const char* ending : {"66.4", "66.7", "481.3"}) {
    const std::string name = absl::StrCat(start, ending);
    const std::size_t at = head.find(name);
    if (at == std::string_view::npos || at + name.size() >= head.size()) continue;
    if (const char next = head[at + name.size()]; next == '\0' || next == '\x02' || next == ' ') return true;
  }
  return false;
}

// Returns the format of an archive or of compressed data that is not read; empty for other data.
std::string_view UnreadFormat(std::string_view bytes) {
  constexpr std::pair<std::string_view, const char*> kMarks[] = {{"7z\xbc\xaf\x27\x1c", "a 7-Zip archive (.7z)"},
                                                                 {"Rar!\x1a\x07", "a RAR archive (.rar)"},
                                                                 {"\xfd\x37zXZ", "compressed by xz"},
                                                                 {"BZh", "compressed by bzip2"},
                                                                 {"\x28\xb5\x2f\xfd", "compressed by Zstandard"}};
  for (const auto& [mark, format] : kMarks) {
    if (bytes.starts_with(mark)) return format;
  }
  if (!IsGzip(bytes)) return "";
  const absl::StatusOr<std::string> start = Inflate("", bytes, kTarHead);
  return start.ok() && IsArchive(*start) ? "an archive compressed by gzip (.tar.gz, .tgz)" : "";
}

absl::Status CheckReadFormat(std::string_view name, std::string_view bytes) {
  const std::string_view format = UnreadFormat(bytes);
  if (format.empty()) return absl::OkStatus();
  return absl::InvalidArgumentError(
      absl::StrCat(std::string(name), ": is ", std::string(format),
                   ", which is not read; unpack it and give the files or their folder, or pack them as .zip or .tar"));
}

// Returns a message without the name at its start.
std::string Unnamed(std::string_view name, const absl::Status& status) {
  const std::string_view message(status.message().data(), status.message().size());
  const std::string_view rest = message.substr(message.starts_with(name) ? name.size() : 0);
  return std::string(rest.substr(std::min(rest.find_first_not_of(": "), rest.size())));
}

}  // namespace

bool IsArchive(std::string_view bytes) {
  return bytes.starts_with("PK\x03\x04") || (bytes.size() > kTarMark && bytes.substr(kTarMark).starts_with("ustar"));
}

absl::StatusOr<LabelVolume> ParseLabels(std::string_view name, std::string_view bytes, std::size_t max_voxels) {
  if (absl::Status status = CheckReadFormat(name, bytes); !status.ok()) return status;
  return IsDicom(bytes) ? ParseDicomSegmentation(name, bytes, max_voxels) : ParseNifti(name, bytes, max_voxels);
}

absl::Status CheckLabelFormat(std::string_view name, std::string_view bytes) {
  if (absl::Status status = CheckReadFormat(name, bytes); !status.ok()) return status;
  if (IsDicom(bytes)) return absl::OkStatus();
  if (!IsGzip(bytes)) return ParseNiftiHeader(name, bytes).status();
  const absl::StatusOr<std::string> start = Inflate(name, bytes, kMaxHeader);
  return start.ok() ? ParseNiftiHeader(name, *start).status() : start.status();
}

LabelStart StartOfLabels(std::string_view name, std::string_view bytes) {
  if (IsDicom(bytes)) return {HasLabelClass(bytes), ""};
  if (IsArchive(bytes)) return {false, "an archive among other files is not read; unpack it, or give it alone"};
  const absl::Status status = CheckLabelFormat(name, bytes);
  if (status.ok()) return {true, ""};
  const std::string ending =
      absl::AsciiStrToLower(std::string(name.substr(name.size() - std::min(name.size(), kLongestEnding))));
  const bool named = absl::EndsWith(ending, ".nii") || absl::EndsWith(ending, ".nii.gz");
  const absl::StatusOr<std::string> start =
      IsGzip(bytes) ? Inflate(name, bytes, kMaxHeader) : std::string(bytes.substr(0, kMaxHeader));
  const bool meant = named || !UnreadFormat(bytes).empty() || (start.ok() && HasNiftiMark(*start));
  return {false, meant ? Unnamed(name, status) : ""};
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
