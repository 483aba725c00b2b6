// Wavefront OBJ, polygonal geometry only (Wavefront, "Object Files (.obj)", appendix B1).
#include <algorithm>
#include <array>
#include <cstdint>

#include "absl/strings/str_cat.h"
#include "server/meshio/formats.h"
#include "server/meshio/frame.h"
#include "server/meshio/text.h"

namespace phrenic::meshio {
namespace {

// Statements that do not affect the geometry.
constexpr std::array<std::string_view, 17> kIgnored = {
    "vt", "vn",    "vp",       "g",        "o",   "s",      "mg",     "usemtl",    "mtllib",
    "p",  "bevel", "c_interp", "d_interp", "lod", "usemap", "maplib", "shadow_obj"};

class ObjParser {
 public:
  ObjParser(std::string_view name, std::string_view bytes) : reader_(name, bytes) {}

  absl::StatusOr<Surface> Parse() {
    while (reader_.NextLine()) {
      // A comment may end in a path's backslash, which is not a continuation.
      if (reader_.Rest().substr(0, 1) != "#") reader_.JoinContinuedLine();
      if (const std::string fault = ReadComment(reader_.Rest()); !fault.empty()) return reader_.Error(fault);
      if (absl::Status status = ReadStatement(reader_.Word()); !status.ok()) return status;
    }
    if (absl::Status status = CheckComplete(); !status.ok()) return status;
    return Surface{builder_.ToMesh(), frame_};
  }

 private:
  // Reads the frame in a line's comment. Returns the fault, or an empty text.
  std::string ReadComment(std::string_view line) {
    const std::size_t start = line.find('#');
    return start == std::string_view::npos ? "" : ReadFrame(line.substr(start), frame_);
  }

  absl::Status ReadStatement(std::string_view keyword) {
    if (keyword.empty() || keyword[0] == '#') return absl::OkStatus();
    if (keyword == "v") return ReadVertex();
    if (keyword == "f") return ReadFace();
    if (keyword == "l") return ReadLine();
    if (std::find(kIgnored.begin(), kIgnored.end(), keyword) != kIgnored.end()) return absl::OkStatus();
    return reader_.Error(absl::StrCat("there is no OBJ statement ", Quoted(keyword),
                                      " for surfaces (v, f and l are read); is this an OBJ file?"));
  }

  absl::Status ReadVertex() {
    double coordinate = 0;
    for (const char* axis : {"x", "y", "z"}) {
      if (!reader_.Number(coordinate)) {
        return reader_.Error(
            absl::StrCat("the vertex's ", axis, " is missing or not a finite number; write \"v x y z\""));
      }
      builder_.coordinates.push_back(coordinate);
    }
    return absl::OkStatus();
  }

  absl::Status ReadFace() {
    if (absl::Status status = ReadCorners(); !status.ok()) return status;
    if (corners_.size() < 3) {
      return reader_.Error(absl::StrCat("a face needs at least 3 vertices, this one has ", corners_.size()));
    }
    builder_.AddPolygon(corners_);
    return absl::OkStatus();
  }

  absl::Status ReadLine() {
    if (absl::Status status = ReadCorners(); !status.ok()) return status;
    if (corners_.size() < 2) return reader_.Error("a line needs at least 2 vertices");
    for (std::size_t i = 1; i < corners_.size(); ++i) {
      builder_.lines.insert(builder_.lines.end(), {corners_[i - 1], corners_[i]});
    }
    return absl::OkStatus();
  }

  // Reads the statement's vertex indices, from 0: "7", "7/1", "7//2", "7/1/2", or "-1" for the latest vertex.
  absl::Status ReadCorners() {
    corners_.clear();
    for (std::string_view word = reader_.Word(); !word.empty() && word[0] != '#'; word = reader_.Word()) {
      std::int64_t index = 0;
      if (!ParseInteger(word.substr(0, word.find('/')), index) || index == 0 || index > INT32_MAX) {
        return reader_.Error(absl::StrCat(Quoted(word), " names no vertex; indices start at 1, or at -1 for the last"));
      }
      if (index < 0 && -index > builder_.vertices()) {
        return reader_.Error(
            absl::StrCat("index ", index, " is before the first vertex; there are ", builder_.vertices(), " so far"));
      }
      corners_.push_back(static_cast<int>(index < 0 ? builder_.vertices() + index : index - 1));
      if (corners_.back() > largest_index_) {
        largest_index_ = corners_.back();
        line_of_largest_ = reader_.line();
      }
    }
    return absl::OkStatus();
  }

  absl::Status CheckComplete() const {
    if (builder_.coordinates.empty()) return reader_.Error("the file has no vertices (\"v x y z\")");
    if (builder_.triangles.empty() && builder_.lines.empty()) {
      return reader_.Error(absl::StrCat("the file has ", builder_.vertices(), " vertices but no faces (\"f 1 2 3\")"));
    }
    if (largest_index_ >= builder_.vertices()) {
      return reader_.ErrorAt(line_of_largest_,
                             absl::StrCat("index ", std::int64_t{largest_index_} + 1,
                                          " is past the last vertex; the file has ", builder_.vertices()));
    }
    return absl::OkStatus();
  }

  TextReader reader_;
  SurfaceBuilder builder_;
  Frame frame_ = Frame::kUnspecified;
  std::vector<int> corners_;
  // A face may precede its vertices, so indices are checked at the end.
  int largest_index_ = -1;
  int line_of_largest_ = 0;
};

}  // namespace

absl::StatusOr<Surface> ParseObj(std::string_view name, std::string_view bytes) {
  return ObjParser(name, bytes).Parse();
}

absl::StatusOr<std::string> WriteObj(const Mesh& mesh) {
  std::string text = "# Phrenic. SPACE=LPS\n";
  for (const auto vertex : mesh.vertices.colwise()) {
    text += "v";
    for (const double coordinate : vertex) AppendNumber(text, coordinate);
    text += "\n";
  }
  for (const auto triangle : mesh.triangles.colwise()) {
    absl::StrAppend(&text, "f ", triangle[0] + 1, " ", triangle[1] + 1, " ", triangle[2] + 1, "\n");
  }
  if (mesh.triangles.cols() > 0) return text;
  for (const auto edge : mesh.edges.colwise()) absl::StrAppend(&text, "l ", edge[0] + 1, " ", edge[1] + 1, "\n");
  return text;
}

}  // namespace phrenic::meshio
