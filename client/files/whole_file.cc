#include "client/files/whole_file.h"

#include <cstdio>
#include <filesystem>
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

bool IsDevice(const std::string& file) {
  std::error_code ignored;
  return std::filesystem::is_other(std::filesystem::status(file, ignored));
}

absl::Status WriteWhole(const std::string& file, const std::string& bytes) {
  const bool device = IsDevice(file);
  const std::string part = device ? file : file + ".part";
  {
    std::ofstream out(part, std::ios::binary);
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    out.close();
    if (out && (device || std::rename(part.c_str(), file.c_str()) == 0)) return absl::OkStatus();
  }
  if (!device) std::remove(part.c_str());
  return absl::DataLossError(
      absl::StrCat("cannot write ", file, ": check that its folder exists and that the disk is not full"));
}

}  // namespace phrenic::client
