#include "server/vtk/image_data.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "server/vtk/xml_writer.h"

namespace phrenic {
namespace {

std::string Numbers(const Eigen::Vector3d& vector) {
  return absl::StrJoin({absl::StrCat(vector.x()), absl::StrCat(vector.y()), absl::StrCat(vector.z())}, " ");
}

}  // namespace

std::string WriteVti(const ImageData& data) {
  XmlWriter writer("ImageData");
  const Eigen::Vector3i last = data.size.array() - 1;
  const std::string extent = absl::StrCat("0 ", last.x(), " 0 ", last.y(), " 0 ", last.z());
  writer.AddXml(absl::StrCat("<ImageData WholeExtent=\"", extent, "\" Origin=\"", Numbers(data.origin), "\" Spacing=\"",
                             Numbers(data.spacing), "\">\n<FieldData>\n"));
  writer.AddText("SPACE", {"LPS"});
  writer.AddXml(absl::StrCat("</FieldData>\n<Piece Extent=\"", extent, "\">\n<PointData>\n"));
  for (const ImageData::Array& array : data.arrays) writer.Add("Float32", array.name, array.values);
  writer.AddXml("</PointData>\n</Piece>\n</ImageData>\n");
  return std::move(writer).Finish();
}

}  // namespace phrenic
