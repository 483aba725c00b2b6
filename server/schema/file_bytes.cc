#include "server/schema/file_bytes.h"

#include <filesystem>
#include <fstream>
#include <sstream>

namespace phrenic {

std::optional<std::string> ReadBytes(const std::string& file) {
  std::error_code error;
  std::ifstream in(file, std::ios::binary);
  std::ostringstream bytes;
  const bool readable = !std::filesystem::is_directory(file, error) && in;
  // Writing no byte sets the output's failbit, which is not an error for an empty file.
  if (!readable || (!(bytes << in.rdbuf()) && in.peek() != std::ifstream::traits_type::eof())) return std::nullopt;
  return std::move(bytes).str();
}

}  // namespace phrenic
