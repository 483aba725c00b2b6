#include "server/record/archive.h"

#include <archive.h>
#include <archive_entry.h>

#include "absl/strings/str_cat.h"

namespace phrenic::record {
namespace {

constexpr int kFileMode = 0644;

}  // namespace

Archive::Archive(Sink sink) : receiver_{std::move(sink), absl::OkStatus()}, zip_(archive_write_new()) {
  archive_write_set_format_zip(zip_);
  archive_write_zip_set_compression_store(zip_);
  archive_write_set_bytes_in_last_block(zip_, 1);  // no padding after the end
  const auto write = [](archive*, void* to, const void* bytes, size_t count) -> la_ssize_t {
    auto& receiver = *static_cast<Receiver*>(to);
    if (receiver.status.ok()) receiver.status = receiver.sink({static_cast<const char*>(bytes), count});
    return receiver.status.ok() ? static_cast<la_ssize_t>(count) : -1;
  };
  (void)archive_write_open(zip_, &receiver_, nullptr, write, nullptr);
}

Archive::~Archive() { archive_write_free(zip_); }

absl::Status Archive::Check(int code) const {
  if (!receiver_.status.ok()) return receiver_.status;
  if (code == ARCHIVE_OK) return absl::OkStatus();
  const char* words = archive_error_string(zip_);
  return absl::InternalError(absl::StrCat("cannot write the archive: ", words == nullptr ? "unknown" : words));
}

absl::Status Archive::Add(const std::string& name, std::string_view bytes) {
  const std::unique_ptr<archive_entry, decltype(&archive_entry_free)> entry(archive_entry_new(), &archive_entry_free);
  archive_entry_set_pathname(entry.get(), name.c_str());
  archive_entry_set_size(entry.get(), static_cast<la_int64_t>(bytes.size()));
  archive_entry_set_filetype(entry.get(), AE_IFREG);
  archive_entry_set_perm(entry.get(), kFileMode);
  if (absl::Status status = Check(archive_write_header(zip_, entry.get())); !status.ok()) return status;
  const auto written = archive_write_data(zip_, bytes.data(), bytes.size());
  return Check(written == static_cast<la_ssize_t>(bytes.size()) ? ARCHIVE_OK : ARCHIVE_FATAL);
}

absl::Status Archive::Finish() { return Check(archive_write_close(zip_)); }

}  // namespace phrenic::record
