#include "client/files/whole_file.h"

#include <cstdio>
#include <fstream>
#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/schema/file_bytes.h"

namespace phrenic::client {

absl::StatusOr<std::string> ReadWhole(const std::string& file, const std::string& what) {
  std::optional<std::string> bytes = ReadBytes(file);
  if (bytes.has_value()) return *std::move(bytes);
  return absl::NotFoundError(
      absl::StrCat("cannot read ", what, " \"", file, "\": check that it exists and that you may read it"));
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
