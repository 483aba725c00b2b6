#include "server/record/distance_map.h"

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "server/mesh/units.h"
#include "server/record/msh.h"
#include "server/record/text_block.h"
#include "server/vtk/polydata.h"

namespace phrenic::record {

const std::vector<MapFormat>& MapFormats() {
  static const auto* const formats = new std::vector<MapFormat>{
      {"msh", "Gmsh 2.2 text: the mesh, and the distance at every time as NodeData", &WriteMshMap},
      {"vtp", "VTK's PolyData for ParaView: the mesh, and the largest distance over all times", &WriteVtpMap},
  };
  return *formats;
}

absl::StatusOr<MapFormat> FindMapFormat(std::string_view name) {
  std::vector<std::string> names;
  for (const MapFormat& format : MapFormats()) {
    if (format.name == name) return format;
    names.emplace_back(format.name);
  }
  return absl::InvalidArgumentError(absl::StrCat("map_format: there is no format \"", std::string(name),
                                                 "\"; there are ", absl::StrJoin(names, ", ")));
}

absl::Status WriteMshMap(const DistanceMap& map, const Sink& sink) {
  const auto mesh = MakeMshRecorder({.sink = sink});
  const Recording recording = {.bodies = {{"surface", map.surface}}};
  if (absl::Status status = mesh->Begin(recording); !status.ok()) return status;
  TextBlock text(sink);
  for (std::size_t step = 0; step < map.times.size(); ++step) {
    const Eigen::VectorXd& distances = map.distances[step];
    text.Append("$NodeData\n1\n\"distance [mm]\"\n1\n%.9g\n3\n%d\n1\n%d\n", map.times[step], step, distances.size());
    for (Eigen::Index i = 0; i < distances.size(); ++i)
      text.Append("%d %.6g\n", i + 1, kMillimetresAMetre * distances[i]);
    text.Append("$EndNodeData\n");
  }
  return text.Flush();
}

absl::Status WriteVtpMap(const DistanceMap& map, const Sink& sink) {
  Eigen::VectorXd largest = map.distances.front();
  for (const Eigen::VectorXd& distances : map.distances) largest = largest.cwiseMax(distances);
  PolyData data = {.points = kMillimetresAMetre * map.surface.vertices, .triangles = map.surface.triangles};
  data.point_arrays.push_back({"distance [mm]", kMillimetresAMetre * largest.transpose()});
  return sink(WriteVtp(data));
}

}  // namespace phrenic::record
