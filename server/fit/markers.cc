#include "server/fit/markers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "server/fit/csv_table.h"

namespace phrenic::fit {
namespace {

constexpr double kLeastExtent = 0.06, kMostExtent = 0.8, kMostMotion = 0.15;  // [m]
constexpr double kFarthestMarker = 1e6;                                       // [mm] from 0
constexpr const char* kMarkerAxes[] = {"_x", "_y", "_z"};

struct MarkerTrack {
  std::string name;
  std::array<int, 3> columns;
};

absl::Status ReadPlace(const CsvTable& table, const std::array<int, 3>& columns, Eigen::Vector3d& place) {
  for (int axis = 0; axis < 3; ++axis) {
    double mm = 0;
    if (absl::Status status = table.Read(columns[static_cast<size_t>(axis)], mm); !status.ok()) return status;
    if (std::abs(mm) > kFarthestMarker) return table.Error("a coordinate is larger than 1e6 mm: check the unit");
    place[axis] = mm / 1000;
  }
  return absl::OkStatus();
}

// Returns the columns PREFIX_x, PREFIX_y, PREFIX_z; -1 for a column that the file lacks.
std::array<int, 3> ColumnsFor(const CsvTable& table, const std::string& prefix) {
  std::array<int, 3> columns = {};
  for (size_t axis = 0; axis < 3; ++axis) {
    const std::string column = prefix + kMarkerAxes[axis];
    columns[axis] = table.Find({column});
  }
  return columns;
}

bool AllThere(const std::array<int, 3>& columns) { return *std::min_element(columns.begin(), columns.end()) >= 0; }

Points ToColumns(const std::vector<Eigen::Vector3d>& places) {
  Points columns(3, static_cast<Eigen::Index>(places.size()));
  for (size_t i = 0; i < places.size(); ++i) columns.col(static_cast<Eigen::Index>(i)) = places[i];
  return columns;
}

absl::StatusOr<Markers> ReadPairs(CsvTable& table) {
  const std::array<int, 3> rest_columns = ColumnsFor(table, "rest"), moved_columns = ColumnsFor(table, "moved");
  if (!AllThere(moved_columns))
    return table.Error("the columns moved_x, moved_y, moved_z are missing: pairs need both");
  const int name = table.Find({"name"});
  Markers markers;
  std::vector<Eigen::Vector3d> rest, motion;
  while (table.Next()) {
    Eigen::Vector3d from, to;
    if (absl::Status status = ReadPlace(table, rest_columns, from); !status.ok()) return status;
    if (absl::Status status = ReadPlace(table, moved_columns, to); !status.ok()) return status;
    if (rest.size() == kMostMarkers) return table.Error(absl::StrCat("more than ", kMostMarkers, " markers"));
    rest.push_back(from);
    motion.emplace_back(to - from);
    markers.names.push_back(name < 0 ? absl::StrCat(rest.size()) : std::string(table.Text(name)));
  }
  markers.rest = ToColumns(rest);
  markers.motion = ToColumns(motion);
  return markers;
}

std::vector<MarkerTrack> TracksOf(const CsvTable& table) {
  std::vector<MarkerTrack> tracks;
  for (const std::string& column : table.names()) {
    if (!column.ends_with("_x")) continue;
    const std::string name = column.substr(0, column.size() - 2);
    const std::array<int, 3> columns = ColumnsFor(table, name);
    if (AllThere(columns)) tracks.push_back({name, columns});
  }
  return tracks;
}

// Returns the mean distance of the markers from their middle.
double SpreadAbout(const Points& places) {
  const Eigen::Vector3d middle = places.rowwise().mean();
  return (places.colwise() - middle).colwise().norm().mean();
}

// Returns the mean of the frames order[from..to).
Points MeanOfFrames(const std::vector<Points>& frames, const std::vector<size_t>& order, size_t from, size_t to) {
  Points sum = Points::Zero(3, frames.front().cols());
  for (size_t k = from; k < to; ++k) sum += frames[order[k]];
  return sum / static_cast<double>(to - from);
}

absl::StatusOr<Markers> ReadTracks(CsvTable& table) {
  const std::vector<MarkerTrack> tracks = TracksOf(table);
  if (tracks.empty()) {
    return table.Error(
        "the first line must name the columns name,rest_x,rest_y,rest_z,moved_x,moved_y,moved_z, or "
        "NAME_x,NAME_y,NAME_z "
        "of each marker of a track");
  }
  if (tracks.size() > kMostMarkers) return table.Error(absl::StrCat("more than ", kMostMarkers, " markers"));
  std::vector<Points> frames;
  while (table.Next()) {
    if (frames.size() * tracks.size() >= kMostMarkerFrames * std::size_t{30}) {
      return table.Error("too many frames: keep every tenth line");
    }
    Points& frame = frames.emplace_back(3, static_cast<Eigen::Index>(tracks.size()));
    for (size_t m = 0; m < tracks.size(); ++m) {
      Eigen::Vector3d place;
      if (absl::Status status = ReadPlace(table, tracks[m].columns, place); !status.ok()) return status;
      frame.col(static_cast<Eigen::Index>(m)) = place;
    }
  }
  if (frames.size() < 10) return table.Error("tracks need 10 frames at least, of a whole breath: or give pairs");
  std::vector<double> spreads;
  spreads.reserve(frames.size());
  for (const Points& frame : frames) spreads.push_back(SpreadAbout(frame));
  std::vector<size_t> order(frames.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return spreads[a] < spreads[b]; });
  const size_t tenth = frames.size() / 10;
  Markers markers;
  for (const MarkerTrack& track : tracks) markers.names.push_back(track.name);
  markers.rest = MeanOfFrames(frames, order, 0, tenth);
  markers.motion = MeanOfFrames(frames, order, frames.size() - tenth, frames.size()) - markers.rest;
  return markers;
}

absl::Status CheckMarkers(std::string_view name, const Markers& markers) {
  const auto refuse = [&](const std::string& text) {
    return absl::InvalidArgumentError(absl::StrCat(std::string(name), ": ", text));
  };
  if (markers.rest.cols() < 3) return refuse("a chest wall's motion needs 3 markers at least");
  const double extent = (markers.rest.rowwise().maxCoeff() - markers.rest.rowwise().minCoeff()).maxCoeff();
  if (!(extent >= kLeastExtent && extent <= kMostExtent)) {
    return refuse(absl::StrFormat("the markers extend %.4g mm, a chest's %g to %g: coordinates must be in mm%s",
                                  1000 * extent, 1000 * kLeastExtent, 1000 * kMostExtent,
                                  extent < kLeastExtent ? " (multiply metres by 1000, centimetres by 10)" : ""));
  }
  const double farthest = markers.motion.colwise().norm().maxCoeff();
  if (farthest <= kMostMotion) return absl::OkStatus();
  return refuse(
      absl::StrFormat("a marker moves by %.4g mm, a chest's by %g at most: are rest and moved places in one "
                      "frame?",
                      1000 * farthest, 1000 * kMostMotion));
}

}  // namespace

absl::StatusOr<Markers> ParseMarkers(std::string_view name, std::string_view bytes) {
  CsvTable table(name, bytes);
  if (absl::Status status = table.ReadHeader(); !status.ok()) return status;
  const bool pairs = AllThere(ColumnsFor(table, "rest"));
  absl::StatusOr<Markers> markers = pairs ? ReadPairs(table) : ReadTracks(table);
  if (!markers.ok()) return markers;
  if (absl::Status status = CheckMarkers(name, *markers); !status.ok()) return status;
  if (table.comments().find("space=ras") != std::string::npos) {
    markers->rest.topRows<2>() *= -1;
    markers->motion.topRows<2>() *= -1;
  }
  markers->centred = table.comments().find("place=centred") != std::string::npos;
  return markers;
}

}  // namespace phrenic::fit
