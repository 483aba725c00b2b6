#include "server/vtk/polydata.h"

#include <cstdint>

#include "absl/strings/str_cat.h"
#include "server/vtk/xml_writer.h"

namespace phrenic {
namespace {

void WriteArrays(const char* section, const std::vector<PolyData::Array>& arrays, XmlWriter& writer) {
  if (arrays.empty()) return;
  // Viewers colour by the active scalars on opening.
  const std::string active =
      arrays.front().values.rows() == 1 ? absl::StrCat(" Scalars=\"", XmlEscaped(arrays.front().name), "\"") : "";
  writer.AddXml(absl::StrCat("<", section, active, ">\n"));
  for (const PolyData::Array& array : arrays) writer.Add("Float64", array.name, array.values);
  writer.AddXml(absl::StrCat("</", section, ">\n"));
}

template <typename Cells>
void WriteCells(const char* section, const Cells& cells, XmlWriter& writer) {
  writer.AddXml(absl::StrCat("<", section, ">\n"));
  writer.Add("Int64", "connectivity", cells.template cast<std::int64_t>().reshaped().transpose());
  const Eigen::Index corners = cells.rows();
  using Offsets = Eigen::Matrix<std::int64_t, 1, Eigen::Dynamic>;
  Offsets offsets = Offsets::LinSpaced(cells.cols(), corners, corners * cells.cols());
  writer.Add("Int64", "offsets", offsets);
  writer.AddXml(absl::StrCat("</", section, ">\n"));
}

}  // namespace

std::string WriteVtp(const PolyData& data) {
  XmlWriter writer("PolyData");
  writer.AddXml("<PolyData>\n<FieldData>\n");
  writer.AddText("SPACE", {"LPS"});
  if (!data.names.empty()) writer.AddText("body names", data.names);
  writer.AddXml(absl::StrCat("</FieldData>\n<Piece NumberOfPoints=\"", data.points.cols(),
                             "\" NumberOfVerts=\"0\" NumberOfLines=\"", data.lines.cols(),
                             "\" NumberOfStrips=\"0\" NumberOfPolys=\"", data.triangles.cols(), "\">\n"));
  WriteArrays("PointData", data.point_arrays, writer);
  WriteArrays("CellData", data.cell_arrays, writer);
  writer.AddXml("<Points>\n");
  writer.Add("Float64", "Points", data.points);
  writer.AddXml("</Points>\n");
  WriteCells("Lines", data.lines, writer);
  WriteCells("Polys", data.triangles, writer);
  writer.AddXml("</Piece>\n</PolyData>\n");
  return std::move(writer).Finish();
}

}  // namespace phrenic
