#include "server/imaging/nifti.h"

#include <algorithm>
#include <limits>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "server/imaging/gzip.h"
#include "server/imaging/nifti_header.h"
#include "server/meshio/bytes.h"

namespace phrenic::imaging {
namespace {

using meshio::AppendBytes;
using meshio::ByteReader;

constexpr std::size_t kMaxDeflateRatio = 1032;  // zlib's manual

// Returns the integer before the next quotation mark, or -1.
int KeyOf(std::string_view text) {
  int key = -1;
  const std::size_t end = text.find('"');
  if (end == std::string_view::npos || !absl::SimpleAtoi(std::string(text.substr(0, end)), &key)) return -1;
  return key;
}

// Reads entries <Label Key="5" ...><![CDATA[liver]]></Label>.
void ReadNames(std::string_view extension, std::map<int, std::string>& names) {
  constexpr std::string_view kEntry = "<Label Key=\"", kOpen = "<![CDATA[", kClose = "]]>";
  for (std::size_t at = extension.find(kEntry); at != std::string_view::npos; at = extension.find(kEntry, at + 1)) {
    const std::size_t open = extension.find(kOpen, at), close = extension.find(kClose, at);
    const int key = KeyOf(extension.substr(at + kEntry.size(), 12));
    if (open == std::string_view::npos || close == std::string_view::npos || close < open || key < 0) continue;
    names[key] = std::string(extension.substr(open + kOpen.size(), close - open - kOpen.size()));
  }
}

// Reads header extensions. Each has its length including these 8 bytes (int32), a code (int32) and its content.
absl::Status ReadExtensions(ByteReader reader, std::string_view bytes, std::size_t end, LabelVolume& volume) {
  while (reader.at() + 8 <= end) {
    const std::size_t at = reader.at();
    std::int32_t length = 0, code = 0;
    if (!reader.Take(length) || !reader.Take(code) || length < 8 || at + length > end || !reader.Skip(length - 8)) {
      return reader.Error("a header extension's length does not fit before the voxels");
    }
    ReadNames(bytes.substr(at + 8, length - 8), volume.names);
  }
  return absl::OkStatus();
}

template <typename T>
absl::Status ReadVoxels(ByteReader reader, std::size_t count, std::vector<Label>& labels) {
  labels.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    T number{};
    reader.Take(number);
    if (std::cmp_less(number, 0) || std::cmp_greater(number, std::numeric_limits<Label>::max())) {
      return reader.Error(absl::StrCat("label ", number, " is outside 0 to 65535; renumber the labels"));
    }
    labels.push_back(static_cast<Label>(number));
  }
  return absl::OkStatus();
}

absl::Status CheckVoxels(std::string_view name, const NiftiHeader& header, std::size_t max_voxels) {
  // As many voxels as the header declares are inflated before they become labels of 2 bytes.
  const bool wide = max_voxels < kMaxVoxels && header.voxels() > max_voxels * sizeof(Label) / header.voxel_bytes;
  if (header.voxels() <= max_voxels && !wide) return absl::OkStatus();
  return absl::ResourceExhaustedError(absl::StrCat(
      std::string(name), ": has ", header.voxels(), " voxels of ", header.voxel_bytes, " bytes, more than ", max_voxels,
      " of 1 or 2 bytes; crop it to the thorax, or save it as uint8 or uint16"));
}

absl::StatusOr<LabelVolume> ParsePlain(std::string_view name, std::string_view bytes, std::size_t max_voxels) {
  const absl::StatusOr<NiftiHeader> header = ParseNiftiHeader(name, bytes);
  if (!header.ok()) return header.status();
  if (absl::Status status = CheckVoxels(name, *header, max_voxels); !status.ok()) return status;
  if (bytes.size() < header->end()) {
    return absl::InvalidArgumentError(absl::StrCat(std::string(name), ": truncated: the header declares ",
                                                   header->end(), " bytes, the file has ", bytes.size(),
                                                   "; download it again"));
  }
  LabelVolume volume;
  volume.size = header->size;
  volume.to_patient = Eigen::Scaling(kRasToLps) * header->to_ras;
  if (bytes[header->length - 4] != 0) {
    const ByteReader reader(name, bytes, header->length, header->order);
    absl::Status status = ReadExtensions(reader, bytes, header->data_at, volume);
    if (!status.ok()) return status;
  }
  absl::Status status;
  WithIntegerOf(header->type, [&](auto number) {
    const ByteReader reader(name, bytes, header->data_at, header->order);
    status = ReadVoxels<decltype(number)>(reader, header->voxels(), volume.labels);
  });
  if (!status.ok()) return status;
  return volume;
}

std::string NamesExtension(const std::map<int, std::string>& names) {
  std::string text =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?><CaretExtension><VolumeInformation Index=\"0\"><LabelTable>";
  for (const auto& [number, name] : names) {
    absl::StrAppend(&text, "<Label Key=\"", number, "\"><![CDATA[", name, "]]></Label>");
  }
  absl::StrAppend(&text,
                  "</LabelTable><VolumeType><![CDATA[Label]]></VolumeType></VolumeInformation></CaretExtension>");
  text.resize((text.size() + 8 + 15) / 16 * 16 - 8, ' ');
  return text;
}

}  // namespace

absl::StatusOr<LabelVolume> ParseNifti(std::string_view name, std::string_view bytes, std::size_t max_voxels) {
  if (!IsGzip(bytes)) return ParsePlain(name, bytes, max_voxels);
  const absl::StatusOr<std::string> start = Inflate(name, bytes, kMaxHeader);
  if (!start.ok()) return start.status();
  const absl::StatusOr<std::size_t> length = NiftiLength(name, *start, max_voxels);
  if (!length.ok()) return length.status();
  if (*length / kMaxDeflateRatio > bytes.size()) {
    return absl::InvalidArgumentError(absl::StrCat(std::string(name), ": the header declares ", *length,
                                                   " bytes, more than a file of ", bytes.size(),
                                                   " can hold; download it again"));
  }
  // Ask for one more byte, so that zlib reaches the end of the stream and verifies the checksum.
  const absl::StatusOr<std::string> whole = Inflate(name, bytes, *length + 1);
  if (!whole.ok()) return whole.status();
  return ParsePlain(name, *whole, max_voxels);
}

absl::StatusOr<std::size_t> NiftiLength(std::string_view name, std::string_view start, std::size_t max_voxels) {
  const absl::StatusOr<NiftiHeader> header = ParseNiftiHeader(name, start);
  if (!header.ok()) return header.status();
  if (absl::Status status = CheckVoxels(name, *header, max_voxels); !status.ok()) return status;
  return header->end();
}

std::string WriteNifti(const LabelVolume& volume) {
  constexpr int kUint16 = 512;
  const std::string names = volume.names.empty() ? "" : NamesExtension(volume.names);
  std::string bytes = NiftiHeaderBytes({{3, volume.size.x(), volume.size.y(), volume.size.z(), 1, 1, 1, 1},
                                        volume.Spacing(),
                                        volume.to_patient,
                                        0,
                                        kUint16,
                                        16,
                                        names.empty() ? 0 : names.size() + 8});
  if (!names.empty()) {
    AppendBytes(bytes, static_cast<std::int32_t>(names.size() + 8));
    AppendBytes(bytes, std::int32_t{0});
    bytes.append(names);
  }
  for (const Label label : volume.labels) AppendBytes(bytes, label);
  return bytes;
}

}  // namespace phrenic::imaging
