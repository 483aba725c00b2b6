// Gmsh's MSH format 2.2 in text (Gmsh reference manual, "MSH file format version 2 (Legacy)").
#include <algorithm>
#include <cstdint>
#include <map>
#include <unordered_map>

#include "absl/strings/str_cat.h"
#include "server/meshio/formats.h"
#include "server/meshio/text.h"

namespace phrenic::meshio {
namespace {

constexpr std::int64_t kLine = 1;
constexpr std::int64_t kTriangle = 2;
constexpr std::int64_t kQuadrilateral = 3;
constexpr std::int64_t kMaxTags = 1000;
constexpr char kRemedy[] = "convert it with: gmsh FILE -save -format msh22 -o NEW.msh";

class MshParser {
 public:
  MshParser(std::string_view name, std::string_view bytes) : reader_(name, bytes) {}

  absl::StatusOr<Mesh> Parse() {
    while (reader_.NextFilledLine()) {
      if (absl::Status status = ReadSection(std::string(reader_.Word())); !status.ok()) return status;
    }
    if (absl::Status status = CheckWhole(); !status.ok()) return status;
    Mesh mesh = found_.ToMesh();
    AddRegions(mesh);
    return mesh;
  }

 private:
  absl::Status ReadSection(const std::string& section) {
    if (section.size() < 2 || section[0] != '$') {
      return reader_.Error(absl::StrCat("a section (\"$Nodes\") is expected, not ", Quoted(section)));
    }
    if (section == "$MeshFormat") return ReadFormat();
    if (!format_read_) return reader_.Error("the file does not start with $MeshFormat; is this a Gmsh file?");
    if (section == "$PhysicalNames") return ReadList("$EndPhysicalNames", &MshParser::ReadPhysicalName);
    if (section == "$Nodes") return ReadList("$EndNodes", &MshParser::ReadNode);
    if (section == "$Elements") return ReadList("$EndElements", &MshParser::ReadElement);
    return PassOver("$End" + section.substr(1));
  }

  absl::Status ReadFormat() {
    double version = 0;
    std::int64_t binary = 0;
    if (!reader_.NextFilledLine() || !reader_.Number(version) || !reader_.Integer(binary)) {
      return reader_.Error("$MeshFormat is not followed by \"2.2 0 8\"");
    }
    if (version < 2 || version >= 3) {
      return reader_.Error(absl::StrCat("MSH version ", version, " is not read, only 2.2 in text; ", kRemedy));
    }
    if (binary != 0) return reader_.Error(absl::StrCat("binary MSH is not read, only 2.2 in text; ", kRemedy));
    format_read_ = true;
    return PassOver("$EndMeshFormat");
  }

  absl::Status PassOver(const std::string& end) {
    while (reader_.NextLine()) {
      if (reader_.Rest() == end) return absl::OkStatus();
    }
    return reader_.Error(absl::StrCat("the file ends before ", end));
  }

  // The claimed count is only compared with what is there: nothing is allocated by it.
  absl::Status ReadList(const char* end, absl::Status (MshParser::*read_row)()) {
    std::int64_t claimed = 0;
    if (!reader_.NextFilledLine() || !reader_.Integer(claimed)) return reader_.Error("the section's count is missing");
    std::int64_t rows = 0;
    while (reader_.NextFilledLine()) {
      if (reader_.Rest() == end) {
        if (rows == claimed) return absl::OkStatus();
        return reader_.Error(absl::StrCat("the section says ", claimed, " rows but has ", rows));
      }
      if (absl::Status status = (this->*read_row)(); !status.ok()) return status;
      ++rows;
    }
    return reader_.Error(absl::StrCat("the file ends before ", end, ", after ", rows, " of ", claimed, " rows"));
  }

  absl::Status ReadPhysicalName() {
    std::int64_t dimension = 0;
    std::int64_t number = 0;
    if (!reader_.Integer(dimension) || !reader_.Integer(number)) {
      return reader_.Error("a physical name is written: dimension number \"name\"");
    }
    std::string_view name = reader_.Rest();
    if (name.size() < 3 || name.front() != '"' || name.back() != '"') {
      return reader_.Error("the physical name is not in double quotes");
    }
    if (dimension == 2) surface_names_[number] = std::string(name.substr(1, name.size() - 2));
    return absl::OkStatus();
  }

  absl::Status ReadNode() {
    std::int64_t number = 0;
    double x = 0;
    double y = 0;
    double z = 0;
    if (!reader_.Integer(number) || !reader_.Number(x) || !reader_.Number(y) || !reader_.Number(z)) {
      return reader_.Error("a node is written: number x y z, all of them finite");
    }
    if (!index_of_.emplace(number, found_.vertices()).second) {
      return reader_.Error(absl::StrCat("node ", number, " is there twice"));
    }
    found_.coordinates.insert(found_.coordinates.end(), {x, y, z});
    return absl::OkStatus();
  }

  absl::Status ReadElement() {
    std::int64_t number = 0;
    std::int64_t type = 0;
    std::int64_t tags = 0;
    if (!reader_.Integer(number) || !reader_.Integer(type) || !reader_.Integer(tags) || tags < 0 || tags > kMaxTags) {
      return reader_.Error("an element is written: number type count-of-tags tags... nodes...");
    }
    std::int64_t physical = 0;
    for (std::int64_t tag = 0, value = 0; tag < tags; ++tag) {
      if (!reader_.Integer(value)) return reader_.Error("a tag of the element is missing or not a whole number");
      if (tag == 0) physical = value;
    }
    if (type == kLine) return ReadCorners(2, physical);
    if (type == kTriangle) return ReadCorners(3, physical);
    if (type == kQuadrilateral) return ReadCorners(4, physical);
    ++passed_over_;
    return absl::OkStatus();
  }

  absl::Status ReadCorners(int count, std::int64_t physical) {
    int corners[4] = {};
    for (int corner = 0; corner < count; ++corner) {
      std::int64_t node = 0;
      if (!reader_.Integer(node)) return reader_.Error(absl::StrCat("the element needs ", count, " node numbers"));
      const auto found = index_of_.find(node);
      if (found == index_of_.end()) {
        return reader_.Error(absl::StrCat("the element names node ", node, ", which is not among the ",
                                          found_.vertices(), " of $Nodes before it"));
      }
      corners[corner] = found->second;
    }
    if (count == 2) found_.lines.insert(found_.lines.end(), corners, corners + 2);
    for (int i = 2; i < count; ++i) {
      found_.triangles.insert(found_.triangles.end(), {corners[0], corners[i - 1], corners[i]});
      physical_of_triangle_.push_back(physical);
    }
    return absl::OkStatus();
  }

  absl::Status CheckWhole() const {
    if (!format_read_) return reader_.Error("the file has no $MeshFormat; is this a Gmsh file?");
    if (found_.coordinates.empty()) return reader_.Error("the file has no nodes");
    if (!found_.triangles.empty() || !found_.lines.empty()) return absl::OkStatus();
    return reader_.Error(absl::StrCat("the file has no triangles, quadrilaterals or lines of first order",
                                      passed_over_ > 0 ? ", only " : "",
                                      passed_over_ > 0 ? absl::StrCat(passed_over_, " elements of other types") : "",
                                      "; make the surface with: gmsh FILE -2 -order 1 -format msh22 -o NEW.msh"));
  }

  void AddRegions(Mesh& mesh) const {
    for (std::size_t triangle = 0; triangle < physical_of_triangle_.size(); ++triangle) {
      const auto name = surface_names_.find(physical_of_triangle_[triangle]);
      if (name == surface_names_.end()) continue;
      std::vector<int>& region = mesh.regions[name->second];
      const auto corners = found_.triangles.begin() + static_cast<std::ptrdiff_t>(3 * triangle);
      region.insert(region.end(), corners, corners + 3);
    }
    for (auto& [name, region] : mesh.regions) {
      std::sort(region.begin(), region.end());
      region.erase(std::unique(region.begin(), region.end()), region.end());
    }
  }

  TextReader reader_;
  Collected found_;
  bool format_read_ = false;
  std::int64_t passed_over_ = 0;
  std::unordered_map<std::int64_t, int> index_of_;  // node number -> vertex
  std::map<std::int64_t, std::string> surface_names_;
  std::vector<std::int64_t> physical_of_triangle_;
};

}  // namespace

absl::StatusOr<Mesh> ParseMsh(std::string_view name, std::string_view bytes) { return MshParser(name, bytes).Parse(); }

}  // namespace phrenic::meshio
