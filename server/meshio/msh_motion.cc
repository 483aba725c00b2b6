// $NodeData sections of Gmsh's MSH format, version 2 text (Gmsh reference manual, "MSH file format version 2
// (Legacy)").
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "server/meshio/formats.h"
#include "server/meshio/meshio.h"
#include "server/meshio/motion.h"
#include "server/meshio/msh_surface.h"
#include "server/meshio/text.h"

namespace phrenic::meshio {
namespace {

constexpr double kMaxTime = 1e9;  // [s]
constexpr char kView[] = "\"displacement\"";

// Reads the time steps of a file. Requires: Parse has accepted the file, so the mesh's sections are valid.
class StepReader {
 public:
  StepReader(std::string_view name, std::string_view bytes, double unit, Motion& motion)
      : reader_(name, bytes), unit_(unit), motion_(motion) {}

  absl::Status Read() {
    while (reader_.NextFilledLine()) {
      const std::string section(reader_.Word());
      absl::Status status;
      if (section == "$Nodes") {
        status = ReadNodeNumbers();
      } else if (section == "$NodeData") {
        status = ReadStep();
      } else {
        SkipTo("$End" + section.substr(1));
      }
      if (!status.ok()) return status;
    }
    return absl::OkStatus();
  }

 private:
  void SkipTo(const std::string& end) {
    while (reader_.NextLine() && reader_.Rest() != end) continue;
  }

  absl::Status ReadNodeNumbers() {
    reader_.NextFilledLine();  // the count
    while (reader_.NextFilledLine() && reader_.Rest() != "$EndNodes") {
      std::int64_t number = 0;
      if (!reader_.Integer(number)) return reader_.Error("a node is written: number x y z");
      index_of_.emplace(number, static_cast<int>(index_of_.size()));
    }
    return absl::OkStatus();
  }

  // Reads a count and that many lines.
  absl::Status ReadTags(const char* what, std::vector<std::string>& tags) {
    std::int64_t count = 0;
    if (!reader_.NextFilledLine() || !reader_.Integer(count) || count < 0 || count > kMaxTags) {
      return reader_.Error(absl::StrCat("the number of the view's ", what, " is missing"));
    }
    for (std::int64_t i = 0; i < count; ++i) {
      if (!reader_.NextFilledLine()) return reader_.Error(absl::StrCat("a ", what, " of the view is missing"));
      tags.emplace_back(reader_.Rest());
    }
    return absl::OkStatus();
  }

  absl::Status ReadStep() {
    std::vector<std::string> texts, reals, integers;
    if (absl::Status status = ReadTags("text tags", texts); !status.ok()) return status;
    if (texts.empty() || texts[0] != kView) {
      SkipTo("$EndNodeData");
      return absl::OkStatus();
    }
    if (absl::Status status = ReadTags("real tags", reals); !status.ok()) return status;
    if (absl::Status status = ReadTime(reals); !status.ok()) return status;
    if (absl::Status status = ReadTags("integer tags", integers); !status.ok()) return status;
    std::int64_t components = 0;
    if (integers.size() < 3 || !ParseInteger(integers[1], components) || components != 3) {
      return reader_.Error(
          "a step of the view \"displacement\" has three integer tags or more: step, 3 (components), rows");
    }
    return ReadRows();
  }

  absl::Status ReadTime(const std::vector<std::string>& reals) {
    TextReader time_reader("", reals.empty() ? std::string_view() : std::string_view(reals[0]));
    double time = 0;
    if (!time_reader.NextLine() || !time_reader.Number(time)) {
      return reader_.Error("a step's first real tag is its time [s], a finite number");
    }
    if (std::abs(time) > kMaxTime) {
      return reader_.Error(absl::StrCat("the step's time is ", time, " s; at most ", kMaxTime, " s is accepted"));
    }
    if (!motion_.times.empty() && time <= motion_.times.back()) {
      return reader_.Error(absl::StrCat("the time ", time, " s is not after that of the step before, ",
                                        motion_.times.back(), " s; sort the steps"));
    }
    motion_.times.push_back(time);
    return absl::OkStatus();
  }

  absl::Status ReadRows() {
    const Eigen::Index vertices = motion_.mesh.vertices.cols();
    Points displacement(3, vertices);
    std::vector<bool> seen(static_cast<std::size_t>(vertices), false);
    Eigen::Index rows = 0;
    while (reader_.NextFilledLine() && reader_.Rest() != "$EndNodeData") {
      std::int64_t number = 0;
      Eigen::Vector3d u;
      if (!reader_.Integer(number) || !reader_.Number(u[0]) || !reader_.Number(u[1]) || !reader_.Number(u[2])) {
        return reader_.Error("a row is written: node dx dy dz, all of them finite");
      }
      const auto found = index_of_.find(number);
      if (found == index_of_.end()) return reader_.Error(absl::StrCat("there is no node ", number, " before this"));
      if (seen[static_cast<std::size_t>(found->second)])
        return reader_.Error(absl::StrCat("node ", number, " is there twice"));
      seen[static_cast<std::size_t>(found->second)] = true;
      displacement.col(found->second) = unit_ * u;
      ++rows;
    }
    if (rows != vertices) {
      return reader_.Error(
          absl::StrCat("the step has rows for ", rows, " of ", vertices, " nodes; it must have one for each"));
    }
    const double largest = vertices > 0 ? displacement.cwiseAbs().maxCoeff() : 0;
    if (!(largest <= kMaxNumber)) {
      return reader_.Error(absl::StrCat("a displacement of ", largest, " m; at most ", kMaxNumber, " is accepted"));
    }
    motion_.displacements.push_back(std::move(displacement));
    return absl::OkStatus();
  }

  TextReader reader_;
  const double unit_;
  Motion& motion_;
  std::unordered_map<std::int64_t, int> index_of_;  // node number -> vertex
};

}  // namespace

absl::StatusOr<Motion> ParseMotion(std::string_view name, std::string_view bytes, double unit) {
  absl::StatusOr<Surface> surface = ParseSurface(name, bytes, unit);
  if (!surface.ok()) return surface.status();
  Motion motion{std::move(surface->mesh), {}, {}};
  if (!absl::EndsWith(absl::AsciiStrToLower(std::string(name)), ".msh")) return motion;
  if (!MshIsVersion2Text(bytes)) {
    if (bytes.find(kView) == std::string_view::npos) return motion;
    return absl::InvalidArgumentError(
        absl::StrCat(std::string(name), ":1: the steps of the view ", kView,
                     " are only read from MSH 2.2 in text; save the views in that format"));
  }
  if (absl::Status status = StepReader(name, bytes, unit, motion).Read(); !status.ok()) return status;
  for (Points& displacement : motion.displacements) {
    if (surface->frame == Frame::kRas) RasToLps(displacement);
  }
  return motion;
}

}  // namespace phrenic::meshio
