#include "server/record/spool_file.h"

#include <fcntl.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"

namespace phrenic::record {
namespace {

// Share of the free space that may be used; other programs write to the disk too.
constexpr double kUsable = 0.95;
constexpr double kMegabyte = 1e6;

absl::Status Cannot(const std::string& what, const std::string& folder, int error) {
  const std::string words = absl::StrCat("cannot ", what, " in the spool folder ", folder, ": ", std::strerror(error),
                                         "; choose another one with --spool DIR");
  if (error == ENOENT || error == ENOTDIR) return absl::NotFoundError(words);
  return error == EACCES ? absl::PermissionDeniedError(words) : absl::InternalError(words);
}

absl::Status Full(const std::string& folder, double needed, double free) {
  return absl::ResourceExhaustedError(
      absl::StrFormat("too little disk space: %.1f MB are needed in the spool folder %s, and %.1f MB are free; "
                      "free some space, record fewer frames, or choose another folder with --spool DIR",
                      needed / kMegabyte, folder, free / kMegabyte));
}

absl::StatusOr<double> Free(const std::string& folder) {
  struct statvfs disk {};
  if (statvfs(folder.c_str(), &disk) != 0) return Cannot("read the free space", folder, errno);
  return static_cast<double>(disk.f_bavail) * static_cast<double>(disk.f_frsize);
}

}  // namespace

std::string DefaultSpoolFolder() {
  const char* chosen = std::getenv("TMPDIR");
  return chosen != nullptr && *chosen != '\0' ? chosen : "/var/tmp";
}

absl::Status CheckRoom(const std::string& folder, std::int64_t bytes) {
  const auto free = Free(folder);
  if (!free.ok()) return free.status();
  return static_cast<double>(bytes) <= kUsable * *free ? absl::OkStatus()
                                                       : Full(folder, static_cast<double>(bytes), *free);
}

absl::StatusOr<std::unique_ptr<SpoolFile>> SpoolFile::Open(const std::string& folder) {
  int descriptor = open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (descriptor < 0 && (errno == EOPNOTSUPP || errno == EISDIR)) {  // the file system does not support unnamed files
    std::string name = folder + "/phrenic-XXXXXX";
    descriptor = mkostemp(name.data(), O_CLOEXEC);
    if (descriptor >= 0) unlink(name.c_str());
  }
  if (descriptor < 0) return Cannot("create a file", folder, errno);
  return std::unique_ptr<SpoolFile>(new SpoolFile(folder, descriptor));
}

SpoolFile::~SpoolFile() { close(descriptor_); }

absl::Status SpoolFile::Append(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = pwrite(descriptor_, bytes.data(), bytes.size(), size_);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0 && errno == ENOSPC) return Full(folder_, static_cast<double>(bytes.size()), 0);
    if (written < 0) return Cannot("write", folder_, errno);
    size_ += written;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return absl::OkStatus();
}

absl::Status SpoolFile::Read(std::int64_t offset, char* to, std::size_t count) const {
  while (count > 0) {
    const ssize_t got = pread(descriptor_, to, count, offset);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return Cannot("read", folder_, errno);
    if (got == 0) return absl::OutOfRangeError(absl::StrCat("the file ends at byte ", offset));
    to += got;
    offset += got;
    count -= static_cast<std::size_t>(got);
  }
  return absl::OkStatus();
}

}  // namespace phrenic::record
