// A file in memory, for parsers that take a path.
#ifndef PHRENIC_TESTS_FUZZ_SCRATCH_FILE_H_
#define PHRENIC_TESTS_FUZZ_SCRATCH_FILE_H_

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <string>

namespace phrenic::fuzz {

class ScratchFile {
 public:
  ScratchFile(const std::uint8_t* data, std::size_t size) : file_(memfd_create("fuzz", MFD_CLOEXEC)) {
    if (file_ < 0 || write(file_, data, size) != static_cast<ssize_t>(size)) std::abort();
  }
  ~ScratchFile() { close(file_); }
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  std::string path() const { return "/proc/self/fd/" + std::to_string(file_); }

 private:
  const int file_;
};

}  // namespace phrenic::fuzz

#endif  // PHRENIC_TESTS_FUZZ_SCRATCH_FILE_H_
