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

// Every index and line number in a file of this size fits an int.
constexpr std::size_t kMaxBytes = std::size_t{1} << 30;

absl::Status TooLarge(const std::string& name) {
  return absl::InvalidArgumentError(
      absl::StrCat(name, ":1: the file is larger than the maximum of 1 GiB; coarsen the surface"));
}

// Returns the format of the file name's extension, ignoring case; null if there is none.
const Format* Find(const std::string& name) {
  for (const Format& format : Formats()) {
    if (absl::EndsWith(absl::AsciiStrToLower(name), std::string(format.ending))) return &format;
  }
  return nullptr;
}

absl::Status CheckReadable(const std::string& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) return absl::NotFoundError(absl::StrCat("there is no file \"", path, "\""));
  if (!std::filesystem::is_regular_file(status)) {
    return absl::InvalidArgumentError(absl::StrCat(path, ":1: not a regular file"));
  }
  if (const auto size = std::filesystem::file_size(path, error); !error && size > kMaxBytes) return TooLarge(path);
  return absl::OkStatus();
}

}  // namespace

const std::vector<Format>& Formats() {
  static const std::vector<Format> formats = {
      {".obj", &ParseObj, &WriteObj}, {".msh", &ParseMsh, &WriteMsh}, {".stl", &ParseStl, &WriteStl},
      {".ply", &ParsePly, &WritePly}, {".vtk", &ParseVtk, &WriteVtk}, {".vtp", &ParseVtp, &WriteVtp},
  };
  return formats;
}

void RasToLps(Points& vectors) { vectors.topRows<2>() = (0.0 - vectors.topRows<2>().array()).matrix(); }

std::string Endings() {
  std::string endings;
  for (const Format& format : Formats()) {
    absl::StrAppend(&endings, endings.empty() ? "" : ", ", std::string(format.ending));
  }
  return endings;
}

std::string WrittenEndings() {
  std::string endings;
  for (const Format& format : Formats()) {
    if (format.write != nullptr) absl::StrAppend(&endings, endings.empty() ? "" : ", ", std::string(format.ending));
  }
  return endings;
}

void SurfaceBuilder::AddPolygon(const std::vector<int>& corners) {
  for (std::size_t i = 2; i < corners.size(); ++i) {
    triangles.insert(triangles.end(), {corners[0], corners[i - 1], corners[i]});
  }
}

Mesh SurfaceBuilder::ToMesh() const {
  Mesh mesh;
  mesh.vertices = Eigen::Map<const Points>(coordinates.data(), 3, vertices());
  mesh.triangles = Eigen::Map<const Triangles>(triangles.data(), 3, static_cast<Eigen::Index>(triangles.size() / 3));
  if (triangles.empty()) {
    mesh.edges = Eigen::Map<const Edges>(lines.data(), 2, static_cast<Eigen::Index>(lines.size() / 2));
  }
  return mesh;
}

absl::StatusOr<Surface> ParseSurface(std::string_view name, std::string_view bytes, double unit) {
  const std::string file(name);
  const Format* format = Find(file);
  if (format == nullptr) {
    return absl::InvalidArgumentError(absl::StrCat(file, ":1: the file name extension is not one of ", Endings()));
  }
  if (bytes.size() > kMaxBytes) return TooLarge(file);
  absl::StatusOr<Surface> surface = format->parse(name, bytes);
  if (!surface.ok()) return surface;
  surface->mesh.vertices *= unit;
  if (surface->frame == Frame::kRas) RasToLps(surface->mesh.vertices);
  if (absl::Status status = Validate(surface->mesh); !status.ok()) {
    return absl::InvalidArgumentError(absl::StrCat(file, ":1: ", status.message()));
  }
  return surface;
}

absl::StatusOr<Mesh> Parse(std::string_view name, std::string_view bytes, double unit) {
  absl::StatusOr<Surface> surface = ParseSurface(name, bytes, unit);
  if (!surface.ok()) return surface.status();
  return std::move(surface->mesh);
}

absl::StatusOr<Surface> ReadSurface(const std::string& path, double unit) {
  if (absl::Status status = CheckReadable(path); !status.ok()) return status;
  std::ifstream file(path, std::ios::binary);
  std::ostringstream bytes;
  if (!file || (!(bytes << file.rdbuf()) && file.peek() != std::ifstream::traits_type::eof())) {
    return absl::PermissionDeniedError(absl::StrCat("\"", path, "\" cannot be read; check the file's permissions"));
  }
  return ParseSurface(path, std::move(bytes).str(), unit);
}

absl::StatusOr<Mesh> ReadFile(const std::string& path, double unit) {
  absl::StatusOr<Surface> surface = ReadSurface(path, unit);
  if (!surface.ok()) return surface.status();
  return std::move(surface->mesh);
}

absl::StatusOr<std::string> Write(std::string_view name, const Mesh& mesh, double unit) {
  const std::string file(name);
  const Format* format = Find(file);
  if (format == nullptr || format->write == nullptr) {
    return absl::InvalidArgumentError(
        absl::StrCat(file, ": the file name extension is not one that can be written: ", WrittenEndings()));
  }
  Mesh scaled = mesh;
  scaled.vertices /= unit;
  absl::Status status = Validate(scaled);
  if (status.ok() && scaled.triangles.cols() == 0 && scaled.edges.cols() == 0) {
    status = absl::InvalidArgumentError("the mesh has neither triangles nor edges to write");
  }
  if (!status.ok()) return absl::InvalidArgumentError(absl::StrCat(file, ": ", status.message()));
  absl::StatusOr<std::string> bytes = format->write(scaled);
  if (bytes.ok()) return bytes;
  return absl::InvalidArgumentError(absl::StrCat(file, ": ", bytes.status().message()));
}

}  // namespace phrenic::meshio
