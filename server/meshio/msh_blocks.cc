// MSH files that store nodes and elements in blocks: version 2 binary, and version 4.1 text and binary (Gmsh reference
// manual, "MSH file format" and "MSH file format version 2 (Legacy)").
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>

#include "absl/strings/str_cat.h"
#include "server/meshio/frame.h"
#include "server/meshio/msh_surface.h"
#include "server/meshio/msh_values.h"

namespace phrenic::meshio {
namespace {

constexpr int kSurfaceDimension = 2;
constexpr int kBox = 6;  // numbers of an entity's bounding box

class BlockParser {
 public:
  BlockParser(std::string_view name, std::string_view bytes, std::size_t at, const MshVersion& version)
      : values_(name, bytes, at, version.binary), version_(version) {}

  absl::StatusOr<Surface> Parse() {
    if (version_.binary && !values_.TakeByteOrder())
      return values_.Error("$MeshFormat is not followed by the number 1");
    if (!values_.Expect("$EndMeshFormat")) return values_.Error("$EndMeshFormat is expected");
    for (std::string section = values_.Word(); !section.empty(); section = values_.Word()) {
      if (absl::Status status = ReadSection(section); !status.ok()) return status;
    }
    if (absl::Status status = surface_.Check(); !status.ok()) return WithPosition(status);
    return Surface{surface_.ToMesh(), frame_};
  }

 private:
  absl::Status WithPosition(const absl::Status& status) const {
    return status.ok() ? status : values_.Error(std::string(status.message()));
  }

  absl::Status ReadSection(const std::string& section) {
    if (section.size() < 2 || section[0] != '$') {
      return values_.Error(absl::StrCat("a section (\"$Nodes\") is expected, not ", Quoted(section)));
    }
    const std::string end = "$End" + section.substr(1);
    absl::Status status;
    if (section == "$PhysicalNames") {
      status = ReadPhysicalNames();
    } else if (section == "$Entities") {
      status = ReadEntities();
    } else if (section == "$Nodes") {
      status = version_.version < 3 ? ReadNodes2() : ReadNodes4();
    } else if (section == "$Elements") {
      status = version_.version < 3 ? ReadElements2() : ReadElements4();
    } else {
      std::string_view text;
      if (!values_.TakeUntil(end, text)) return values_.Error(absl::StrCat("the file ends before ", end));
      const std::string fault = section == "$Comments" ? ReadFrame(text, frame_) : "";
      return fault.empty() ? absl::OkStatus() : values_.Error(fault);
    }
    if (!status.ok()) return status;
    if (values_.Expect(end)) return absl::OkStatus();
    return values_.Error(
        absl::StrCat(end, " is expected here: the section has more rows than it declares, or is truncated"));
  }

  absl::Status Missing(const char* what) const {
    return values_.Error(absl::StrCat(what, " is missing or not a number: is the file truncated?"));
  }

  absl::Status ReadPhysicalNames() {
    std::int64_t count = 0;
    if (!values_.TextInteger(count)) return Missing("the count of physical names");
    for (std::int64_t i = 0; i < count; ++i) {
      const std::string_view line = values_.Line();
      if (line.empty()) return Missing("a physical name");
      if (absl::Status status = surface_.AddPhysicalName(line); !status.ok()) return WithPosition(status);
    }
    return absl::OkStatus();
  }

  // Reads points, curves, surfaces and volumes; keeps only the physical tags of surfaces.
  absl::Status ReadEntities() {
    std::int64_t counts[4] = {};
    if (!values_.StartBlock()) return Missing("the number of entities");
    for (std::int64_t& count : counts) {
      if (!values_.Size(count)) return Missing("the number of entities");
    }
    for (int dimension = 0; dimension < 4; ++dimension) {
      for (std::int64_t i = 0; i < counts[dimension]; ++i) {
        if (!ReadEntity(dimension)) return Missing("a number of an entity");
      }
    }
    return absl::OkStatus();
  }

  bool ReadEntity(int dimension) {
    std::int64_t tag = 0, count = 0, physical = 0;
    double coordinate = 0;
    if (!values_.Int(tag)) return false;
    for (int i = 0; i < (dimension == 0 ? 3 : kBox); ++i) {
      if (!values_.Double(coordinate)) return false;
    }
    if (!values_.Size(count)) return false;
    for (std::int64_t i = 0; i < count; ++i) {
      if (!values_.Int(physical)) return false;
      // Negative if the entity has reversed orientation in the group.
      if (dimension == kSurfaceDimension && i == 0) physical_of_[tag] = std::abs(std::max(physical, -INT64_MAX));
    }
    if (dimension == 0) return true;
    if (!values_.Size(count)) return false;
    for (std::int64_t i = 0; i < count; ++i) {
      if (!values_.Int(tag)) return false;
    }
    return true;
  }

  absl::Status AddNode(std::int64_t number, int parameters) {
    double at[3] = {}, parameter = 0;
    for (double& coordinate : at) {
      if (!values_.Double(coordinate)) return Missing("a node's coordinate");
      if (!std::isfinite(coordinate)) return values_.Error(absl::StrCat("node ", number, " is not at finite numbers"));
    }
    for (int i = 0; i < parameters; ++i) {
      if (!values_.Double(parameter)) return Missing("a node's parameter");
    }
    return WithPosition(surface_.AddNode(number, at[0], at[1], at[2]));
  }

  absl::Status ReadNodes2() {
    std::int64_t count = 0, number = 0;
    if (!values_.TextInteger(count) || !values_.StartBlock()) return Missing("the count of nodes");
    for (std::int64_t i = 0; i < count; ++i) {
      if (!values_.Int(number)) return Missing("a node's number");
      if (absl::Status status = AddNode(number, 0); !status.ok()) return status;
    }
    return absl::OkStatus();
  }

  absl::Status ReadElements2() {
    std::int64_t count = 0;
    if (!values_.TextInteger(count) || !values_.StartBlock()) return Missing("the count of elements");
    while (count > 0) {
      std::int64_t type = 0, rows = 0, tags = 0;
      if (!values_.Int(type) || !values_.Int(rows) || !values_.Int(tags))
        return Missing("the head of a block of elements");
      if (rows < 1 || rows > count || tags < 0 || tags > kMaxTags) {
        return values_.Error(absl::StrCat("a block declares ", rows, " elements with ", tags, " tags, but ", count,
                                          " elements are left"));
      }
      count -= rows;
      for (; rows > 0; --rows) {
        if (absl::Status status = ReadElement(type, tags, 0); !status.ok()) return status;
      }
    }
    return absl::OkStatus();
  }

  // `tags` is the number of tags in version 2, the first of which replaces `physical`.
  absl::Status ReadElement(std::int64_t type, std::int64_t tags, std::int64_t physical) {
    std::int64_t number = 0;
    if (!Index(number)) return Missing("an element's number");
    for (std::int64_t i = 0, tag = 0; i < tags; ++i) {
      if (!values_.Int(tag)) return Missing("a tag of an element");
      if (i == 0) physical = tag;
    }
    nodes_.resize(static_cast<std::size_t>(MshNodesOf(type)));
    if (nodes_.empty()) return values_.Error(absl::StrCat("there is no type ", type, " of elements"));
    for (std::int64_t& node : nodes_) {
      if (!Index(node)) return Missing("a node of an element");
    }
    return WithPosition(surface_.AddElement(type, nodes_, physical));
  }

  // Reads a node or element number: 4 bytes in version 2, 8 in version 4.
  bool Index(std::int64_t& index) { return version_.version < 3 ? values_.Int(index) : values_.Size(index); }

  absl::Status ReadBlockCount(std::int64_t& blocks, const char* what) {
    std::int64_t rows = 0, least = 0, most = 0;
    if (values_.StartBlock() && values_.Size(blocks) && values_.Size(rows) && values_.Size(least) &&
        values_.Size(most)) {
      return absl::OkStatus();
    }
    return Missing(what);
  }

  absl::Status ReadNodes4() {
    std::int64_t blocks = 0;
    if (absl::Status status = ReadBlockCount(blocks, "the count of nodes"); !status.ok()) return status;
    for (; blocks > 0; --blocks) {
      std::int64_t dimension = 0, tag = 0, parametric = 0, rows = 0, number = 0;
      if (!values_.Int(dimension) || !values_.Int(tag) || !values_.Int(parametric) || !values_.Size(rows)) {
        return Missing("the head of a block of nodes");
      }
      if (dimension < 0 || dimension > 3) return values_.Error(absl::StrCat("there is no dimension ", dimension));
      nodes_.clear();
      for (std::int64_t i = 0; i < rows; ++i) {
        if (!values_.Size(number)) return Missing("a node's number");
        nodes_.push_back(number);
      }
      for (const std::int64_t node : nodes_) {
        const int parameters = parametric != 0 ? static_cast<int>(dimension) : 0;
        if (absl::Status status = AddNode(node, parameters); !status.ok()) return status;
      }
    }
    return absl::OkStatus();
  }

  absl::Status ReadElements4() {
    std::int64_t blocks = 0;
    if (absl::Status status = ReadBlockCount(blocks, "the count of elements"); !status.ok()) return status;
    for (; blocks > 0; --blocks) {
      std::int64_t dimension = 0, entity = 0, type = 0, rows = 0;
      if (!values_.Int(dimension) || !values_.Int(entity) || !values_.Int(type) || !values_.Size(rows)) {
        return Missing("the head of a block of elements");
      }
      const auto physical = physical_of_.find(entity);
      const bool named = dimension == kSurfaceDimension && physical != physical_of_.end();
      for (; rows > 0; --rows) {
        if (absl::Status status = ReadElement(type, 0, named ? physical->second : 0); !status.ok()) return status;
      }
    }
    return absl::OkStatus();
  }

  MshValues values_;
  const MshVersion version_;
  MshSurface surface_;
  Frame frame_ = Frame::kUnspecified;
  std::vector<std::int64_t> nodes_;
  std::map<std::int64_t, std::int64_t> physical_of_;  // surface entity -> physical group
};

}  // namespace

absl::StatusOr<Surface> ParseMshBlocks(std::string_view name, std::string_view bytes, std::size_t at,
                                       const MshVersion& version) {
  return BlockParser(name, bytes, at, version).Parse();
}

}  // namespace phrenic::meshio
