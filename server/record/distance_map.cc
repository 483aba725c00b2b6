#include "server/record/distance_map.h"

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "server/mesh/units.h"
#include "server/record/msh.h"
#include "server/record/text_block.h"

namespace phrenic::record {
namespace {}  // namespace

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
  const auto mesh = MakeMshRecorder(sink);
  if (absl::Status status = mesh->Begin({{"surface", map.surface}}); !status.ok()) return status;
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
  const Points& x = map.surface.vertices;
  const Triangles& triangles = map.surface.triangles;
  Eigen::VectorXd largest = map.distances.front();
  for (const Eigen::VectorXd& distances : map.distances) largest = largest.cwiseMax(distances);
  TextBlock text(sink);
  text.Append(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"LittleEndian\">\n<PolyData>\n"
      "<Piece NumberOfPoints=\"%d\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" "
      "NumberOfPolys=\"%d\">\n<PointData Scalars=\"distance [mm]\">\n"
      "<DataArray type=\"Float64\" Name=\"distance [mm]\" format=\"ascii\">\n",
      x.cols(), triangles.cols());
  for (Eigen::Index i = 0; i < largest.size(); ++i) text.Append("%.6g\n", kMillimetresAMetre * largest[i]);
  text.Append(
      "</DataArray>\n</PointData>\n<Points>\n<DataArray type=\"Float64\" NumberOfComponents=\"3\" "
      "format=\"ascii\">\n");
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    text.Append("%.9g %.9g %.9g\n", kMillimetresAMetre * x(0, i), kMillimetresAMetre * x(1, i),
                kMillimetresAMetre * x(2, i));
  }
  text.Append("</DataArray>\n</Points>\n<Polys>\n<DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">\n");
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    text.Append("%d %d %d\n", triangles(0, t), triangles(1, t), triangles(2, t));
  }
  text.Append("</DataArray>\n<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">\n");
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) text.Append("%d\n", 3 * (t + 1));
  text.Append("</DataArray>\n</Polys>\n</Piece>\n</PolyData>\n</VTKFile>\n");
  return text.Flush();
}

}  // namespace phrenic::record
