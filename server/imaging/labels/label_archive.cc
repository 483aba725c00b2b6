#include "server/imaging/labels/label_archive.h"

#include <archive.h>
#include <archive_entry.h>

#include <memory>
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/imaging/dicom_file.h"
#include "server/imaging/gzip.h"
#include "server/imaging/label_file.h"
#include "server/imaging/labels/label_set.h"
#include "server/imaging/nifti.h"

namespace phrenic::imaging {
namespace {

constexpr std::size_t kMostBytes = std::size_t{4} << 30;  // of all files
constexpr int kMostEntries = 5000;                        // also folders and files that are left out
constexpr std::size_t kMostVoxelBytes = 4;                // of a file, for each voxel that a volume may have

using ArchiveReader = std::unique_ptr<archive, decltype(&archive_read_free)>;

absl::Status Damaged(const std::string& name, archive* reader) {
  const char* words = archive_error_string(reader);
  return absl::InvalidArgumentError(absl::StrCat(name, ": cannot be unpacked: ", words == nullptr ? "damaged" : words,
                                                 "; pack the label files again, or give them one by one"));
}

// Appends the next block of the file that the reader is at; nothing at its end. `left` is what all files may still have
// [bytes].
absl::Status ReadBlock(const std::string& name, archive* reader, std::size_t& left, std::string& bytes) {
  constexpr std::size_t kBlock = std::size_t{1} << 18;
  std::string block(kBlock, '\0');
  const la_ssize_t got = archive_read_data(reader, block.data(), block.size());
  if (got < 0) return Damaged(name, reader);
  const auto size = static_cast<std::size_t>(got);
  if (size > left) {
    return absl::ResourceExhaustedError(absl::StrCat(name, ": its files have more than 4 GiB; pack only label files"));
  }
  left -= size;
  bytes.append(block, 0, size);
  return absl::OkStatus();
}

// Reads on in a label file whose first block is `bytes`. An uncompressed NIfTI file is refused by its header, and read
// to the end that the header declares.
absl::Status ReadRest(const std::string& name, archive* reader, const std::string& file, std::size_t max_voxels,
                      std::size_t& left, std::string& bytes) {
  std::size_t wanted = kMostBytes;
  if (!IsGzip(bytes) && !IsDicom(bytes)) {
    const absl::StatusOr<std::size_t> length = NiftiLength(file, bytes, max_voxels);
    if (!length.ok()) return length.status();
    wanted = *length;
  }
  for (std::size_t before = 0; before < bytes.size() && bytes.size() < wanted;) {
    before = bytes.size();
    if (absl::Status status = ReadBlock(name, reader, left, bytes); !status.ok()) return status;
    if (bytes.size() / kMostVoxelBytes <= max_voxels) continue;
    return absl::ResourceExhaustedError(absl::StrCat(file, ": is unpacked to more than ", kMostVoxelBytes * max_voxels,
                                                     " bytes, the most for a volume of ", max_voxels,
                                                     " voxels; crop it to the thorax"));
  }
  return absl::OkStatus();
}

// Adds the file that the reader is at. One that is no label file is left out after its first block: it may be huge.
absl::Status AddFile(const std::string& name, archive* reader, const std::string& file, const std::string& choice,
                     std::size_t max_voxels, std::size_t& left, LabelSet& labels) {
  std::string bytes;
  if (absl::Status status = ReadBlock(name, reader, left, bytes); !status.ok()) return status;
  if (const LabelStart start = StartOfLabels(file, bytes); !start.readable) {
    labels.LeaveOut(file, start.problem);
    return absl::OkStatus();
  }
  if (absl::Status status = ReadRest(name, reader, file, max_voxels, left, bytes); !status.ok()) return status;
  absl::StatusOr<LabelVolume> volume = ParseLabels(file, bytes, max_voxels);
  if (!volume.ok()) return volume.status();
  return labels.Add(file, *std::move(volume), choice);
}

// Returns the path of a file in the archive. libarchive cannot convert all of UTF-8 in the locale "C".
std::string PathOf(archive_entry* entry, int number) {
  for (const char* path : {archive_entry_pathname_utf8(entry), archive_entry_pathname(entry)}) {
    if (path != nullptr) return path;
  }
  return absl::StrCat("file ", number);
}

}  // namespace

absl::StatusOr<LabelVolume> ParseLabelArchive(const std::string& name, std::string_view bytes,
                                              const std::string& choice, std::size_t max_voxels,
                                              const std::function<bool()>& stopped) {
  const ArchiveReader reader(archive_read_new(), &archive_read_free);
  archive_read_support_format_zip(reader.get());
  archive_read_support_format_tar(reader.get());
  if (archive_read_open_memory(reader.get(), bytes.data(), bytes.size()) != ARCHIVE_OK) {
    return Damaged(name, reader.get());
  }
  LabelSet labels;
  archive_entry* entry = nullptr;
  std::size_t left = kMostBytes;
  int code = ARCHIVE_OK, entries = 0;
  while ((code = archive_read_next_header(reader.get(), &entry)) == ARCHIVE_OK || code == ARCHIVE_WARN) {
    if (++entries > kMostEntries) {
      return absl::ResourceExhaustedError(
          absl::StrCat(name, ": has more than ", kMostEntries, " files; pack only label files"));
    }
    if (stopped != nullptr && stopped()) return absl::CancelledError(absl::StrCat(name, ": reading was cancelled"));
    if (archive_entry_filetype(entry) != AE_IFREG) continue;
    const std::string file = PathOf(entry, entries);
    if (absl::Status status = AddFile(name, reader.get(), file, choice, max_voxels, left, labels); !status.ok()) {
      return status;
    }
  }
  if (code != ARCHIVE_EOF) return Damaged(name, reader.get());
  if (labels.empty()) {
    return absl::InvalidArgumentError(absl::StrCat(
        name, ": has no label file: pack NIfTI, DICOM Segmentation or RT Structure Set", labels.LeftOutWords()));
  }
  return labels.Finish();
}

}  // namespace phrenic::imaging
