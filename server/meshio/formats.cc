#include "server/meshio/formats.h"

#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "server/meshio/meshio.h"

namespace phrenic::meshio {
namespace {

// Every index and line number of a file of this size fits an int.
constexpr std::size_t kMaxBytes = std::size_t{1} << 30;

absl::Status TooLarge(const std::string& name) {
  return absl::InvalidArgumentError(
      absl::StrCat(name, ":1: the file is larger than 1 GiB, the most that is read; make the surface coarser"));
}

absl::StatusOr<Format> FormatOf(const std::string& name) {
  std::string endings;
  for (const Format& format : Formats()) {
    const std::string ending(format.ending);
    if (absl::EndsWith(absl::AsciiStrToLower(name), ending)) return format;
    absl::StrAppend(&endings, endings.empty() ? "" : ", ", ending);
  }
  return absl::InvalidArgumentError(
      absl::StrCat(name, ":1: the name's ending tells no known format; there are ", endings));
}

absl::Status CheckReadable(const std::string& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) return absl::NotFoundError(absl::StrCat("there is no file \"", path, "\""));
  if (!std::filesystem::is_regular_file(status)) {
    return absl::InvalidArgumentError(absl::StrCat(path, ":1: not a file that can be read as a surface"));
  }
  if (const auto size = std::filesystem::file_size(path, error); !error && size > kMaxBytes) return TooLarge(path);
  return absl::OkStatus();
}

}  // namespace

const std::vector<Format>& Formats() {
  static const std::vector<Format> formats = {
      {".obj", &ParseObj},
      {".msh", &ParseMsh},
  };
  return formats;
}

Mesh Collected::ToMesh() const {
  Mesh mesh;
  mesh.vertices = Eigen::Map<const Points>(coordinates.data(), 3, vertices());
  mesh.triangles = Eigen::Map<const Triangles>(triangles.data(), 3, static_cast<Eigen::Index>(triangles.size() / 3));
  if (triangles.empty()) {
    mesh.edges = Eigen::Map<const Edges>(lines.data(), 2, static_cast<Eigen::Index>(lines.size() / 2));
  }
  return mesh;
}

absl::StatusOr<Mesh> Parse(std::string_view name, std::string_view bytes, double unit) {
  const std::string file(name);
  const auto format = FormatOf(file);
  if (!format.ok()) return format.status();
  if (bytes.size() > kMaxBytes) return TooLarge(file);
  absl::StatusOr<Mesh> mesh = format->parse(name, bytes);
  if (!mesh.ok()) return mesh;
  mesh->vertices *= unit;
  if (absl::Status status = Validate(*mesh); !status.ok()) {
    return absl::InvalidArgumentError(absl::StrCat(file, ":1: ", status.message()));
  }
  return mesh;
}

absl::StatusOr<Mesh> ReadFile(const std::string& path, double unit) {
  if (absl::Status status = CheckReadable(path); !status.ok()) return status;
  std::ifstream file(path, std::ios::binary);
  std::ostringstream bytes;
  if (!file || (!(bytes << file.rdbuf()) && file.peek() != std::ifstream::traits_type::eof())) {
    return absl::PermissionDeniedError(absl::StrCat("\"", path, "\" cannot be read; check who may read it"));
  }
  return Parse(path, std::move(bytes).str(), unit);
}

}  // namespace phrenic::meshio
