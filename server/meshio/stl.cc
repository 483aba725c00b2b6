// STL, text and binary (3D Systems, "StereoLithography Interface Specification", 1989). Triangles stand alone in it:
// vertices at exactly one place become one.
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
#include "server/meshio/text.h"

namespace phrenic::meshio {
namespace {

constexpr std::size_t kHeader = 80;    // [bytes]
constexpr std::size_t kTriangle = 50;  // [bytes]: normal and three corners in float32, two bytes of attributes
constexpr std::size_t kNormal = 12;    // [bytes]

struct Place {
  std::array<std::uint64_t, 3> bits;
  bool operator==(const Place&) const = default;
};

struct PlaceHash {
  std::size_t operator()(const Place& place) const {
    std::uint64_t hash = 0;
    for (const std::uint64_t bits : place.bits) {
      hash = (hash ^ bits) * 0x9e3779b97f4a7c15U;
      hash ^= hash >> 32;
    }
    return hash;
  }
};

// Gathers triangles; each place becomes one vertex, numbered where it is first seen.
class Welder {
 public:
  void AddCorner(const Eigen::Vector3d& at) {
    Place place{};
    for (int axis = 0; axis < 3; ++axis) place.bits[axis] = std::bit_cast<std::uint64_t>(at[axis] + 0.0);  // -0 is 0
    const auto [found, fresh] = vertex_at_.emplace(place, found_.vertices());
    if (fresh) found_.coordinates.insert(found_.coordinates.end(), {at[0], at[1], at[2]});
    found_.triangles.push_back(found->second);
  }

  std::size_t corners() const { return found_.triangles.size(); }
  Mesh ToMesh() const { return found_.ToMesh(); }

 private:
  Collected found_;
  std::unordered_map<Place, int, PlaceHash> vertex_at_;
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
    if (inside_) return reader_.Error("the file ends before \"endsolid\": it was cut off; fetch or export it again");
    if (welder_.corners() == 0) return reader_.Error("the file has no triangles (\"facet\")");
    return Surface{welder_.ToMesh(), frame_};
  }

 private:
  absl::Status ReadStatement(const std::string& keyword) {
    if (keyword == "solid" && !inside_) {
      frame_ = FrameIn(reader_.Rest(), frame_);
      inside_ = true;
      return absl::OkStatus();
    }
    if (!inside_) return reader_.Error(absl::StrCat("\"solid\" is expected, not ", Quoted(keyword)));
    if (keyword == "facet") return ReadFacet();
    if (keyword != "endsolid") {
      return reader_.Error(absl::StrCat("\"facet\" or \"endsolid\" is expected, not ", Quoted(keyword)));
    }
    inside_ = false;
    return absl::OkStatus();
  }

  // What the normal says follows from the corners; some programs write NaN there.
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
      return reader_.Error(absl::StrCat("the file ends where \"", keyword, "\" is expected: it was cut off"));
    }
    const std::string_view word = reader_.Word();
    if (absl::AsciiStrToLower(std::string(word)) == keyword) return absl::OkStatus();
    return reader_.Error(absl::StrCat("\"", keyword, "\" is expected, not ", Quoted(word),
                                      "; a facet has three corners, each on a line of its own"));
  }

  TextReader reader_;
  Welder welder_;
  Frame frame_ = Frame::kUnsaid;
  bool inside_ = false;  // between "solid" and "endsolid"
};

// The number of triangles that the 80 bytes of header are followed by; 0 in a shorter file.
std::uint32_t ClaimedTriangles(std::string_view bytes) {
  std::uint32_t count = 0;
  ByteReader("", bytes, kHeader).Take(count);
  return count;
}

std::size_t SizeOf(std::uint32_t triangles) { return kHeader + sizeof(std::uint32_t) + kTriangle * triangles; }

absl::Status CheckSize(std::string_view name, std::string_view bytes) {
  const std::uint32_t count = ClaimedTriangles(bytes);
  if (bytes.size() < SizeOf(0)) {
    return ByteReader(name, bytes, bytes.size())
        .Error("the file is neither an STL in text (\"solid\") nor long enough for one in binary; is this an STL?");
  }
  if (bytes.size() == SizeOf(count) && count > 0) return absl::OkStatus();
  return ByteReader(name, bytes, kHeader)
      .Error(absl::StrCat("the file says ", count, " triangles, which take ", SizeOf(count), " bytes, but has ",
                          bytes.size(), "; was it cut off, or is it no STL?"));
}

absl::StatusOr<Surface> ParseBinary(std::string_view name, std::string_view bytes) {
  if (absl::Status status = CheckSize(name, bytes); !status.ok()) return status;
  ByteReader reader(name, bytes, SizeOf(0));
  Welder welder;
  while (reader.Skip(kNormal)) {
    for (int corner = 0; corner < 3; ++corner) {
      float x = 0, y = 0, z = 0;
      const ByteReader start = reader;
      if (!reader.Take(x) || !reader.Take(y) || !reader.Take(z)) return reader.Error("the file ends in a triangle");
      if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z)) {
        return start.Error(absl::StrCat("triangle ", welder.corners() / 3, " has a corner that is not finite"));
      }
      welder.AddCorner({x, y, z});
    }
    reader.Skip(sizeof(std::uint16_t));
  }
  return Surface{welder.ToMesh(), FrameIn(bytes.substr(0, kHeader), Frame::kUnsaid)};
}

bool IsText(std::string_view bytes) {
  const std::size_t first = bytes.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return false;
  return absl::AsciiStrToLower(std::string(bytes.substr(first, 5))) == "solid" &&
         bytes.substr(0, SizeOf(0)).find('\0') == std::string_view::npos;
}

}  // namespace

// Programs write binary files whose header begins with "solid" too. The size tells: in a text of less than 1 GiB, the
// four bytes where a binary file has its count make a larger number than fit.
absl::StatusOr<Surface> ParseStl(std::string_view name, std::string_view bytes) {
  const bool sized = bytes.size() >= SizeOf(0) && bytes.size() == SizeOf(ClaimedTriangles(bytes));
  return !sized && IsText(bytes) ? TextParser(name, bytes).Parse() : ParseBinary(name, bytes);
}

absl::StatusOr<std::string> WriteStl(const Mesh& mesh) {
  if (mesh.triangles.cols() == 0) {
    return absl::InvalidArgumentError("STL holds triangles and the mesh has edges alone; write another format");
  }
  std::string bytes = "Phrenic. SPACE=LPS";
  bytes.resize(kHeader, ' ');
  AppendBytes(bytes, static_cast<std::uint32_t>(mesh.triangles.cols()));
  for (const auto triangle : mesh.triangles.colwise()) {
    const Eigen::Vector3d a = mesh.vertices.col(triangle[0]), b = mesh.vertices.col(triangle[1]);
    const Eigen::Vector3d c = mesh.vertices.col(triangle[2]), normal = (b - a).cross(c - a).stableNormalized();
    for (const Eigen::Vector3d& row : {normal, a, b, c}) {
      const Eigen::Vector3f small = row.cast<float>();
      if (!small.allFinite()) return absl::InvalidArgumentError("a coordinate is too large for STL's float32");
      for (const float number : small) AppendBytes(bytes, number);
    }
    AppendBytes(bytes, std::uint16_t{0});
  }
  return bytes;
}

}  // namespace phrenic::meshio
