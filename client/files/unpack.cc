#include "client/files/unpack.h"

#include <archive.h>
#include <archive_entry.h>

#include <filesystem>
#include <fstream>
#include <memory>

#include "absl/strings/str_cat.h"

namespace phrenic::client {
namespace {

constexpr std::size_t kBlock = std::size_t{1} << 20;  // [bytes]

absl::Status CannotRead(const std::string& name, archive* zip) {
  const char* words = archive_error_string(zip);
  return absl::DataLossError(absl::StrCat("cannot unpack ", name, ": ", words == nullptr ? "unknown" : words));
}

absl::Status CopyEntry(const std::string& name, archive* zip, const std::filesystem::path& to) {
  std::error_code ignored;
  std::filesystem::create_directories(to.parent_path(), ignored);
  std::ofstream out(to, std::ios::binary);
  std::string block(kBlock, '\0');
  while (true) {
    const la_ssize_t got = archive_read_data(zip, block.data(), block.size());
    if (got < 0) return CannotRead(name, zip);
    if (got == 0) break;
    out.write(block.data(), got);
  }
  out.close();
  if (out) return absl::OkStatus();
  return absl::DataLossError(
      absl::StrCat("cannot write ", to.string(), ": check that its folder exists and that the disk is not full"));
}

}  // namespace

absl::Status Unpack(const std::string& name, const std::string& folder) {
  const std::unique_ptr<archive, decltype(&archive_read_free)> zip(archive_read_new(), &archive_read_free);
  archive_read_support_format_zip(zip.get());
  if (archive_read_open_filename(zip.get(), name.c_str(), kBlock) != ARCHIVE_OK) return CannotRead(name, zip.get());
  archive_entry* entry = nullptr;
  int code = ARCHIVE_OK;
  while ((code = archive_read_next_header(zip.get(), &entry)) == ARCHIVE_OK) {
    const std::filesystem::path inside(archive_entry_pathname(entry));
    bool escapes = inside.is_absolute();
    for (const auto& part : inside) escapes = escapes || part == "..";
    if (escapes) return absl::DataLossError(absl::StrCat(name, ": ", inside.string(), " is a path outside the folder"));
    absl::Status copied = CopyEntry(name, zip.get(), std::filesystem::path(folder) / inside);
    if (!copied.ok()) return copied;
  }
  return code == ARCHIVE_EOF ? absl::OkStatus() : CannotRead(name, zip.get());
}

}  // namespace phrenic::client
