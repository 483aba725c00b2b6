// Distance maps: a surface with each vertex' distance to another surface, for colour mapping. README.md in this folder
// specifies the formats.
#ifndef PHRENIC_SERVER_RECORD_DISTANCE_MAP_H_
#define PHRENIC_SERVER_RECORD_DISTANCE_MAP_H_

#include <string_view>
#include <vector>

#include "server/record/recorder.h"

namespace phrenic::record {

// Plain data. `times` and `distances` have the same size, and each element of `distances` one number per vertex.
struct DistanceMap {
  Mesh surface;                            // triangles, at rest [m]
  std::vector<double> times;               // [s], at least one
  std::vector<Eigen::VectorXd> distances;  // per time: of each vertex [m], finite
};

// `write` passes the file to the sink in order, on the calling thread. Thread-safe.
struct MapFormat {
  std::string_view name;  // also the file name extension, without its dot
  std::string_view description;
  absl::Status (*write)(const DistanceMap& map, const Sink& sink);
};

// The catalogue of formats, one row each. It lives as long as the process. All functions here are thread-safe.
const std::vector<MapFormat>& MapFormats();

// Returns the format of that name. INVALID_ARGUMENT lists the known names.
absl::StatusOr<MapFormat> FindMapFormat(std::string_view name);

// Writes Gmsh 2.2 text: one step of the view "distance [mm]" per time. Returns the sink's error. Distances are in
// millimetres, with 6 digits.
absl::Status WriteMshMap(const DistanceMap& map, const Sink& sink);
// Writes VTK XML PolyData: the maximum over all times as the point data "distance [mm]". Returns the sink's error.
// Points and distances are in millimetres, as float64; the sink gets the file in one call.
absl::Status WriteVtpMap(const DistanceMap& map, const Sink& sink);

}  // namespace phrenic::record

#endif  // PHRENIC_SERVER_RECORD_DISTANCE_MAP_H_
