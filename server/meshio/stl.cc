// STL, text and binary (3D Systems, "StereoLithography Interface Specification", 1989). The format has no shared
// vertices; bitwise equal points become one vertex.
#include <Eigen/Geometry>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "server/meshio/bytes.h"
#include "server/meshio/formats.h"
#include "server/meshio/frame.h"
#include "server/meshio/text.h"

namespace phrenic::meshio {
namespace {

constexpr std::size_t kHeader = 80;    // [bytes]
constexpr std::size_t kTriangle = 50;  // [bytes]: normal and three corners as float32, attribute count as uint16
constexpr std::size_t kNormal = 12;    // [bytes]

// The bit patterns of a point's coordinates.
struct PointBits {
  std::array<std::uint64_t, 3> bits;
  bool operator==(const PointBits&) const = default;
};

struct PointBitsHash {
  std::size_t operator()(const PointBits& point) const {
    std::uint64_t hash = 0;
    for (const std::uint64_t bits : point.bits) {
      hash = (hash ^ bits) * 0x9e3779b97f4a7c15U;
      hash ^= hash >> 32;
    }
    return hash;
  }
};

// Collects triangles and merges equal points into one vertex, numbered by first occurrence.
class Welder {
 public:
  void AddCorner(const Eigen::Vector3d& at) {
    PointBits point{};
    for (int axis = 0; axis < 3; ++axis) point.bits[axis] = std::bit_cast<std::uint64_t>(at[axis] + 0.0);  // -0 -> 0
    const auto [vertex, inserted] = vertex_at_.emplace(point, builder_.vertices());
    if (inserted) builder_.coordinates.insert(builder_.coordinates.end(), {at[0], at[1], at[2]});
    builder_.triangles.push_back(vertex->second);
  }

  std::size_t corners() const { return builder_.triangles.size(); }
  Mesh ToMesh() const { return builder_.ToMesh(); }

 private:
  SurfaceBuilder builder_;
  std::unordered_map<PointBits, int, PointBitsHash> vertex_at_;
};

class TextParser {
 public:
  TextParser(std::string_view name, std::string_view bytes) : reader_(name, bytes) {}

  absl::StatusOr<Surface> Parse() {
    while (reader_.NextFilledLine()) {
      if (absl::Status status = ReadStatement(absl::AsciiStrToLower(std::string(reader_.Word()))); !status.ok()) {
        return status;
      }
    }
    if (inside_)
      return reader_.Error("the file ends before \"endsolid\": it is truncated; download or export it again");
    if (welder_.corners() == 0) return reader_.Error("the file has no triangles (\"facet\")");
    return Surface{welder_.ToMesh(), frame_};
  }

 private:
  absl::Status ReadStatement(const std::string& keyword) {
    if (keyword == "solid" && !inside_) {
      inside_ = true;
      const std::string fault = ReadFrame(reader_.Rest(), frame_);
      return fault.empty() ? absl::OkStatus() : reader_.Error(fault);
    }
    if (!inside_) return reader_.Error(absl::StrCat("\"solid\" is expected, not ", Quoted(keyword)));
    if (keyword == "facet") return ReadFacet();
    if (keyword != "endsolid") {
      return reader_.Error(absl::StrCat("\"facet\" or \"endsolid\" is expected, not ", Quoted(keyword)));
    }
    inside_ = false;
    return absl::OkStatus();
  }

  // Ignores the normal, which follows from the corners; some programs write NaN there.
  absl::Status ReadFacet() {
    if (absl::Status status = Expect("outer"); !status.ok()) return status;
    for (int corner = 0; corner < 3; ++corner) {
      if (absl::Status status = Expect("vertex"); !status.ok()) return status;
      Eigen::Vector3d at;
      if (!reader_.Number(at[0]) || !reader_.Number(at[1]) || !reader_.Number(at[2]) || !reader_.Rest().empty()) {
        return reader_.Error("a corner is written: vertex x y z, all of them finite");
      }
      welder_.AddCorner(at);
    }
    if (absl::Status status = Expect("endloop"); !status.ok()) return status;
    return Expect("endfacet");
  }

  absl::Status Expect(const std::string& keyword) {
    if (!reader_.NextFilledLine()) {
      return reader_.Error(absl::StrCat("the file ends where \"", keyword, "\" is expected: it is truncated"));
    }
    const std::string_view word = reader_.Word();
    if (absl::AsciiStrToLower(std::string(word)) == keyword) return absl::OkStatus();
    return reader_.Error(absl::StrCat("\"", keyword, "\" is expected, not ", Quoted(word),
                                      "; a facet has three corners, each on its own line"));
  }

  TextReader reader_;
  Welder welder_;
  Frame frame_ = Frame::kUnspecified;
  bool inside_ = false;  // between "solid" and "endsolid"
};

// Returns the triangle count that follows the 80-byte header; 0 if the file is shorter.
std::uint32_t DeclaredTriangles(std::string_view bytes) {
  std::uint32_t count = 0;
  ByteReader("", bytes, kHeader).Take(count);
  return count;
}

std::size_t SizeOf(std::uint32_t triangles) { return kHeader + sizeof(std::uint32_t) + kTriangle * triangles; }

absl::Status CheckSize(std::string_view name, std::string_view bytes) {
  const std::uint32_t count = DeclaredTriangles(bytes);
  if (bytes.size() < SizeOf(0)) {
    return ByteReader(name, bytes, bytes.size())
        .Error("the file is neither text STL (\"solid\") nor long enough for binary STL; is this an STL file?");
  }
  if (bytes.size() == SizeOf(count) && count > 0) return absl::OkStatus();
  return ByteReader(name, bytes, kHeader)
      .Error(absl::StrCat("the file declares ", count, " triangles, which take ", SizeOf(count), " bytes, but has ",
                          bytes.size(), "; it is truncated or not an STL file"));
}

absl::StatusOr<Surface> ParseBinary(std::string_view name, std::string_view bytes) {
  if (absl::Status status = CheckSize(name, bytes); !status.ok()) return status;
  Frame frame = Frame::kUnspecified;
  if (const std::string fault = ReadFrame(bytes.substr(0, kHeader), frame); !fault.empty()) {
    return ByteReader(name, bytes, 0).Error(fault);
  }
  ByteReader reader(name, bytes, SizeOf(0));
  Welder welder;
  while (reader.Skip(kNormal)) {
    for (int corner = 0; corner < 3; ++corner) {
      float x = 0, y = 0, z = 0;
      const ByteReader start = reader;
      if (!reader.Take(x) || !reader.Take(y) || !reader.Take(z)) return reader.Error("the file ends within a triangle");
      if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z)) {
        return start.Error(absl::StrCat("triangle ", welder.corners() / 3, " has a corner that is not finite"));
      }
      welder.AddCorner({x, y, z});
    }
    reader.Skip(sizeof(std::uint16_t));
  }
  return Surface{welder.ToMesh(), frame};
}

bool IsText(std::string_view bytes) {
  const std::size_t first = bytes.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return false;
  return absl::AsciiStrToLower(std::string(bytes.substr(first, 5))) == "solid" &&
         bytes.substr(0, SizeOf(0)).find('\0') == std::string_view::npos;
}

}  // namespace

// Some programs start the header of binary files with "solid". The size decides: in text, the four bytes at the
// position of the binary count give a size above 1 GiB, the maximum.
absl::StatusOr<Surface> ParseStl(std::string_view name, std::string_view bytes) {
  const bool size_matches = bytes.size() >= SizeOf(0) && bytes.size() == SizeOf(DeclaredTriangles(bytes));
  return !size_matches && IsText(bytes) ? TextParser(name, bytes).Parse() : ParseBinary(name, bytes);
}

absl::StatusOr<std::string> WriteStl(const Mesh& mesh) {
  if (mesh.triangles.cols() == 0) {
    return absl::InvalidArgumentError("STL holds only triangles and the mesh has only edges; write another format");
  }
  std::string bytes = "Phrenic. SPACE=LPS";
  bytes.resize(kHeader, ' ');
  AppendBytes(bytes, static_cast<std::uint32_t>(mesh.triangles.cols()));
  for (const auto triangle : mesh.triangles.colwise()) {
    const Eigen::Vector3d a = mesh.vertices.col(triangle[0]), b = mesh.vertices.col(triangle[1]);
    const Eigen::Vector3d c = mesh.vertices.col(triangle[2]), normal = (b - a).cross(c - a).stableNormalized();
    for (const Eigen::Vector3d& row : {normal, a, b, c}) {
      for (const double number : row) AppendBytes(bytes, static_cast<float>(number));
    }
    AppendBytes(bytes, std::uint16_t{0});
  }
  return bytes;
}

}  // namespace phrenic::meshio
