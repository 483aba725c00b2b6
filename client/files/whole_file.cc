#include "client/files/whole_file.h"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "absl/strings/str_cat.h"

namespace phrenic::client {

absl::StatusOr<std::string> ReadWhole(const std::string& file, const std::string& what) {
  std::error_code error;
  std::ifstream in(file, std::ios::binary);
  std::ostringstream bytes;
  const bool readable = !std::filesystem::is_directory(file, error) && in;
  if (!readable || (!(bytes << in.rdbuf()) && in.peek() != std::ifstream::traits_type::eof())) {
    return absl::NotFoundError(
        absl::StrCat("cannot read ", what, " \"", file, "\": check that it exists and that you may read it"));
  }
  return std::move(bytes).str();
}

absl::Status WriteWhole(const std::string& file, const std::string& bytes) {
  const std::string part = file + ".part";
  {
    std::ofstream out(part, std::ios::binary);
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    out.close();
    if (out && std::rename(part.c_str(), file.c_str()) == 0) return absl::OkStatus();
  }
  std::remove(part.c_str());
  return absl::DataLossError(
      absl::StrCat("cannot write ", file, ": check that its folder exists and that the disk is not full"));
}

}  // namespace phrenic::client
