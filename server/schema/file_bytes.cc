#include "server/schema/file_bytes.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>

namespace phrenic {

std::optional<std::string> ReadBytes(const std::string& file, std::size_t most) {
  std::error_code error;
  std::ifstream in(file, std::ios::binary);
  if (!in || std::filesystem::is_directory(file, error)) return std::nullopt;
  std::string bytes;
  std::array<char, 1 << 16> block;
  while (in.read(block.data(), block.size()) || in.gcount() > 0) {
    bytes.append(block.data(), static_cast<std::size_t>(in.gcount()));
    if (bytes.size() > most) return std::nullopt;
  }
  return in.bad() ? std::nullopt : std::optional(std::move(bytes));
}

}  // namespace phrenic
