#include "server/fit/slicer_points.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "absl/strings/str_cat.h"
#include "server/fit/csv_cells.h"
#include "server/meshio/text.h"

namespace phrenic::fit {
namespace {

using nlohmann::json;

// Reads "# CoordinateSystem = LPS". Returns false for a system that is neither LPS nor RAS.
bool ReadSystem(std::string_view line, bool& ras) {
  const std::string_view system = Trimmed(line.substr(std::min(line.size(), line.find('=') + 1)));
  ras = system == "RAS" || system == "0";
  return ras || system == "LPS" || system == "1";
}

absl::Status AppendFcsvRow(const meshio::TextReader& reader, bool ras, std::vector<Eigen::Vector3d>& points,
                           Landmarks& landmarks) {
  const std::vector<std::string_view> cells = CellsOf(reader.Rest());
  Eigen::Vector3d mm;
  for (int axis = 0; axis < 3; ++axis) {
    if (cells.size() < 4 || !meshio::ParseNumber(cells[axis + 1], mm[axis])) {
      return reader.Error("a point is a line id,x,y,z,... with numbers; save the markups again in 3D Slicer");
    }
  }
  if (absl::Status status = AppendPoint(mm, ras, points); !status.ok()) {
    return reader.Error(std::string(status.message()));
  }
  landmarks.labels.emplace_back(cells.size() > 11 ? cells[11] : "");
  return absl::OkStatus();
}

// Returns the value of a key, or null.
const json* Find(const json& object, const char* key) {
  if (!object.is_object()) return nullptr;
  const auto found = object.find(key);
  return found == object.end() ? nullptr : &*found;
}

std::string TextAt(const json& object, const char* key) {
  const json* text = Find(object, key);
  return text != nullptr && text->is_string() ? text->get<std::string>() : "";
}

// Appends the point of one entry of controlPoints. Undefined points (positionStatus) are errors.
absl::Status AppendControlPoint(const json& entry, bool ras, std::vector<Eigen::Vector3d>& points) {
  const json* position = Find(entry, "position");
  if (position == nullptr || !position->is_array() || position->size() != 3) {
    return absl::InvalidArgumentError("its position must be three numbers: place the point in 3D Slicer");
  }
  Eigen::Vector3d mm;
  for (int axis = 0; axis < 3; ++axis) {
    if (!(*position)[axis].is_number()) return absl::InvalidArgumentError("its position must be three numbers");
    mm[axis] = (*position)[axis].get<double>();
  }
  return AppendPoint(mm, ras, points);
}

}  // namespace

absl::Status AppendPoint(const Eigen::Vector3d& mm, bool ras, std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d metres = mm / 1000;
  if (!metres.allFinite() || metres.cwiseAbs().maxCoeff() > kFarthest) {
    return absl::InvalidArgumentError(
        absl::StrCat("coordinates are finite numbers up to ", kFarthest, " m: remove the point, or check the unit"));
  }
  if (ras) metres.head<2>() *= -1;
  points.push_back(metres);
  return absl::OkStatus();
}

Points ColumnsOf(const std::vector<Eigen::Vector3d>& points) {
  Points columns(3, static_cast<Eigen::Index>(points.size()));
  for (size_t i = 0; i < points.size(); ++i) columns.col(static_cast<Eigen::Index>(i)) = points[i];
  return columns;
}

absl::StatusOr<Landmarks> ParseFcsv(std::string_view name, std::string_view bytes) {
  meshio::TextReader reader(name, bytes);
  bool ras = true;
  Landmarks landmarks;
  std::vector<Eigen::Vector3d> points;
  while (reader.NextFilledLine()) {
    const std::string_view line = reader.Rest();
    if (line.front() != '#') {
      if (absl::Status status = AppendFcsvRow(reader, ras, points, landmarks); !status.ok()) return status;
    } else if (line.find("CoordinateSystem") != std::string_view::npos && !ReadSystem(line, ras)) {
      return reader.Error("the coordinate system must be LPS or RAS");
    }
  }
  landmarks.exhale = ColumnsOf(points);
  return landmarks;
}

absl::StatusOr<Landmarks> ParseMarkups(std::string_view name, std::string_view bytes) {
  const auto error = [&](const std::string& message) {
    return absl::InvalidArgumentError(absl::StrCat(std::string(name), ": ", message));
  };
  const json document = json::parse(bytes, nullptr, false);
  const json* markups = Find(document, "markups");
  if (markups == nullptr || !markups->is_array() || markups->empty()) {
    return error("no \"markups\" with a list: save the points as .mrk.json in 3D Slicer");
  }
  const json& markup = markups->front();
  const std::string system = TextAt(markup, "coordinateSystem"), unit = TextAt(markup, "coordinateUnits");
  if (system != "LPS" && system != "RAS") return error("coordinateSystem must be LPS or RAS");
  if (!unit.empty() && unit != "mm") return error("coordinateUnits must be mm");
  const json* list = Find(markup, "controlPoints");
  if (list == nullptr || !list->is_array()) return error("the markup has no \"controlPoints\"");
  Landmarks landmarks;
  std::vector<Eigen::Vector3d> points;
  for (const json& entry : *list) {
    if (absl::Status status = AppendControlPoint(entry, system == "RAS", points); !status.ok()) {
      return error(absl::StrCat("point ", points.size() + 1, ": ", status.message()));
    }
    landmarks.labels.push_back(TextAt(entry, "label"));
  }
  landmarks.exhale = ColumnsOf(points);
  return landmarks;
}

}  // namespace phrenic::fit
