// Colour maps of a surface: each vertex with its distance to another surface. README.md beside this file is the format.
#ifndef PHRENIC_SERVER_RECORD_DISTANCE_MAP_H_
#define PHRENIC_SERVER_RECORD_DISTANCE_MAP_H_

#include <string_view>
#include <vector>

#include "server/record/recorder.h"

namespace phrenic::record {

struct DistanceMap {
  Mesh surface;                            // at rest [m]; of triangles
  std::vector<double> times;               // [s], at least one
  std::vector<Eigen::VectorXd> distances;  // one a time, of each vertex [m], finite
};

struct MapFormat {
  std::string_view name;  // also the file name's ending
  std::string_view description;
  absl::Status (*write)(const DistanceMap& map, const Sink& sink);
};

// The catalogue: one row a format.
const std::vector<MapFormat>& MapFormats();

// INVALID_ARGUMENT with the names there are.
absl::StatusOr<MapFormat> FindMapFormat(std::string_view name);

// Gmsh 2.2 text: every time as a step of the view "distance [mm]".
absl::Status WriteMshMap(const DistanceMap& map, const Sink& sink);
// VTK's PolyData in XML: the largest over all times as the point data "distance [mm]".
absl::Status WriteVtpMap(const DistanceMap& map, const Sink& sink);

}  // namespace phrenic::record

#endif  // PHRENIC_SERVER_RECORD_DISTANCE_MAP_H_
