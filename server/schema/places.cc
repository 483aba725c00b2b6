#include "server/schema/places.h"

#include <filesystem>

namespace phrenic {

std::string Installed(const std::string& name, const std::string& otherwise) {
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  const std::filesystem::path folder = program.parent_path().parent_path() / "share/phrenic" / name;
  return !error && std::filesystem::is_directory(folder, error) ? folder.string() : otherwise;
}

}  // namespace phrenic
