#include "server/vtk/unstructured_grid.h"

#include <cstdint>
#include <utility>

#include "absl/strings/str_cat.h"
#include "server/vtk/xml_writer.h"

namespace phrenic {
namespace {

constexpr int kVoxel = 11;  // VTK_VOXEL

void WriteGridArrays(const char* section, const std::vector<UnstructuredGrid::Array>& arrays, XmlWriter& writer) {
  writer.AddXml(absl::StrCat("<", section, ">\n"));
  for (const UnstructuredGrid::Array& array : arrays) writer.Add("Float32", array.name, array.values);
  writer.AddXml(absl::StrCat("</", section, ">\n"));
}

}  // namespace

std::string WriteVtu(const UnstructuredGrid& grid) {
  using Row = Eigen::Matrix<std::int64_t, 1, Eigen::Dynamic>;
  using Types = Eigen::Matrix<std::uint8_t, 1, Eigen::Dynamic>;
  const Eigen::Index count = grid.cells.cols();
  XmlWriter writer("UnstructuredGrid");
  writer.AddXml("<UnstructuredGrid>\n<FieldData>\n");
  writer.AddText("SPACE", {"LPS"});
  writer.AddXml(absl::StrCat("</FieldData>\n<Piece NumberOfPoints=\"", grid.points.cols(), "\" NumberOfCells=\"", count,
                             "\">\n"));
  WriteGridArrays("PointData", grid.point_arrays, writer);
  WriteGridArrays("CellData", grid.cell_arrays, writer);
  writer.AddXml("<Points>\n");
  writer.Add("Float64", "Points", grid.points);
  writer.AddXml("</Points>\n<Cells>\n");
  const Row corners = grid.cells.cast<std::int64_t>().reshaped().transpose();
  Row offsets(count);
  for (Eigen::Index i = 0; i < count; ++i) offsets[i] = 8 * (i + 1);
  writer.Add("Int64", "connectivity", corners);
  writer.Add("Int64", "offsets", offsets);
  const Types types = Types::Constant(count, kVoxel);
  writer.Add("UInt8", "types", types);
  writer.AddXml("</Cells>\n</Piece>\n</UnstructuredGrid>\n");
  return std::move(writer).Finish();
}

}  // namespace phrenic
