#include "server/meshio/ply_header.h"

#include <climits>
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/meshio/frame.h"

namespace phrenic::meshio {
namespace {

bool ReadType(std::string_view word, PlyType& type) {
  static constexpr std::pair<std::string_view, PlyType> kTypes[] = {
      {"char", PlyType::kInt8},       {"int8", PlyType::kInt8},       {"uchar", PlyType::kUint8},
      {"uint8", PlyType::kUint8},     {"short", PlyType::kInt16},     {"int16", PlyType::kInt16},
      {"ushort", PlyType::kUint16},   {"uint16", PlyType::kUint16},   {"int", PlyType::kInt32},
      {"int32", PlyType::kInt32},     {"uint", PlyType::kUint32},     {"uint32", PlyType::kUint32},
      {"float", PlyType::kFloat32},   {"float32", PlyType::kFloat32}, {"double", PlyType::kFloat64},
      {"float64", PlyType::kFloat64},
  };
  for (const auto& [name, named] : kTypes) {
    if (name != word) continue;
    type = named;
    return true;
  }
  return false;
}

bool IsReal(PlyType type) { return type == PlyType::kFloat32 || type == PlyType::kFloat64; }

class HeaderReader {
 public:
  explicit HeaderReader(TextReader& reader) : reader_(reader) {}

  absl::StatusOr<PlyHeader> Read() {
    if (!reader_.NextLine() || reader_.Rest() != "ply") return reader_.Error("the file does not start with \"ply\"");
    if (!reader_.NextLine() || reader_.Word() != "format")
      return reader_.Error("the second line is not \"format ...\"");
    if (absl::Status status = ReadFormat(); !status.ok()) return status;
    while (reader_.NextLine()) {
      const std::string keyword(reader_.Word());
      if (keyword == "end_header") return Validated();
      if (absl::Status status = ReadStatement(keyword); !status.ok()) return status;
    }
    return reader_.Error("the file ends before \"end_header\"");
  }

 private:
  absl::Status ReadFormat() {
    const std::string_view encoding = reader_.Word();
    if (encoding == "binary_little_endian") {
      header_.encoding = PlyEncoding::kLittleEndian;
    } else if (encoding == "binary_big_endian") {
      header_.encoding = PlyEncoding::kBigEndian;
    } else if (encoding != "ascii") {
      return reader_.Error(
          absl::StrCat("the encoding ", Quoted(encoding),
                       " is unknown; supported are ascii, binary_little_endian and binary_big_endian"));
    }
    if (reader_.Word() == "1.0") return absl::OkStatus();
    return reader_.Error("the version is not 1.0, the only supported one");
  }

  absl::Status ReadStatement(const std::string& keyword) {
    if (keyword == "comment" || keyword == "obj_info") {
      const std::string fault = ReadFrame(reader_.Rest(), header_.frame);
      return fault.empty() ? absl::OkStatus() : reader_.Error(fault);
    }
    if (keyword == "element") return ReadElement();
    if (keyword == "property") return ReadProperty();
    return reader_.Error(absl::StrCat("there is no PLY statement ", Quoted(keyword)));
  }

  absl::Status ReadElement() {
    PlyElement element;
    element.name = std::string(reader_.Word());
    if (!reader_.Integer(element.count) || element.count < 0 || element.count > INT_MAX) {
      return reader_.Error("an element is written: element name count");
    }
    header_.elements.push_back(std::move(element));
    return absl::OkStatus();
  }

  absl::Status ReadProperty() {
    if (header_.elements.empty()) return reader_.Error("a property precedes the first element");
    PlyProperty property;
    std::string_view word = reader_.Word();
    if (word == "list") {
      property.list = true;
      word = reader_.Word();
      if (!ReadType(word, property.count_type) || IsReal(property.count_type)) {
        return reader_.Error(absl::StrCat("a list's length must have an integer type, not ", Quoted(word)));
      }
      word = reader_.Word();
    }
    if (!ReadType(word, property.type)) return reader_.Error(absl::StrCat("there is no PLY type ", Quoted(word)));
    property.name = std::string(reader_.Word());
    if (property.name.empty()) return reader_.Error("a property is written: property type name");
    header_.elements.back().properties.push_back(std::move(property));
    return absl::OkStatus();
  }

  // Returns the header if it is consistent. Rejects elements without properties: their rows take no bytes, so the
  // declared count could not be checked.
  absl::StatusOr<PlyHeader> Validated() {
    bool vertices = false;
    for (const PlyElement& element : header_.elements) {
      if (element.properties.empty()) {
        return reader_.Error(absl::StrCat("element ", Quoted(element.name), " has no properties"));
      }
      if (element.name != "vertex") continue;
      if (vertices) return reader_.Error("there are two elements \"vertex\"");
      vertices = true;
      for (const char* axis : {"x", "y", "z"}) {
        const int property = element.Find(axis);
        if (property < 0 || element.properties[static_cast<std::size_t>(property)].list) {
          return reader_.Error(absl::StrCat("the vertices have no property \"", axis, "\""));
        }
      }
    }
    if (!vertices) return reader_.Error("the file has no element \"vertex\"");
    return std::move(header_);
  }

  TextReader& reader_;
  PlyHeader header_;
};

}  // namespace

int PlyElement::Find(std::string_view property) const {
  for (std::size_t i = 0; i < properties.size(); ++i) {
    if (properties[i].name == property) return static_cast<int>(i);
  }
  return -1;
}

absl::StatusOr<PlyHeader> ReadPlyHeader(TextReader& reader) { return HeaderReader(reader).Read(); }

}  // namespace phrenic::meshio
