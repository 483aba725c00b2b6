#include "server/vtk/polydata.h"

#include <zlib.h>

#include <bit>
#include <cstdint>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"

namespace phrenic {
namespace {

static_assert(std::endian::native == std::endian::little, "the file declares byte_order LittleEndian");

constexpr int kLevel = 1;  // zlib's fastest; higher levels barely shrink coordinates further

std::string Escaped(const std::string& text) {
  return absl::StrReplaceAll(text, {{"&", "&amp;"}, {"<", "&lt;"}, {">", "&gt;"}, {"\"", "&quot;"}});
}

// Builds the XML text and the appended binary data side by side.
class Writer {
 public:
  // Adds a DataArray: one tuple per column of `values`.
  template <typename Derived>
  void Add(const char* type, const std::string& name, const Eigen::MatrixBase<Derived>& values) {
    const typename Derived::PlainObject plain = values;
    absl::StrAppend(&head_, "<DataArray type=\"", type, "\" Name=\"", Escaped(name), "\" NumberOfComponents=\"",
                    plain.rows(), "\" format=\"appended\" offset=\"", appended_.size(), "\"/>\n");
    Append(plain.data(), sizeof(typename Derived::Scalar) * static_cast<std::size_t>(plain.size()));
  }

  // Adds a String array: the character codes of each text, ended by 0.
  void AddText(const std::string& name, const std::vector<std::string>& texts) {
    absl::StrAppend(&head_, "<Array type=\"String\" Name=\"", name, "\" NumberOfTuples=\"", texts.size(),
                    "\" format=\"ascii\">");
    for (const std::string& text : texts) {
      for (const char character : text) absl::StrAppend(&head_, static_cast<unsigned char>(character), " ");
      head_ += "0 ";
    }
    head_ += "</Array>\n";
  }

  void AddXml(const std::string& text) { head_ += text; }
  std::string Finish() && {
    return absl::StrCat(head_, "<AppendedData encoding=\"raw\">\n_", appended_, "\n</AppendedData>\n</VTKFile>\n");
  }

 private:
  // Appends a compressed array of one block: header (number of blocks, uncompressed block size, size of a partial last
  // block or 0, compressed size), then the zlib stream.
  void Append(const void* bytes, std::size_t size) {
    if (size == 0) return AppendHeader({0, 0, 0});
    uLongf packed = compressBound(size);
    std::string block(packed, '\0');
    compress2(reinterpret_cast<Bytef*>(block.data()), &packed, static_cast<const Bytef*>(bytes), size, kLevel);
    AppendHeader({1, size, 0, packed});
    appended_.append(block, 0, packed);
  }

  void AppendHeader(std::initializer_list<std::uint64_t> numbers) {
    for (const std::uint64_t number : numbers) {
      appended_.append(reinterpret_cast<const char*>(&number), sizeof number);
    }
  }

  std::string head_, appended_;
};

void WriteArrays(const char* section, const std::vector<PolyData::Array>& arrays, Writer& writer) {
  if (arrays.empty()) return;
  // Viewers colour by the active scalars on opening.
  const std::string active =
      arrays.front().values.rows() == 1 ? absl::StrCat(" Scalars=\"", Escaped(arrays.front().name), "\"") : "";
  writer.AddXml(absl::StrCat("<", section, active, ">\n"));
  for (const PolyData::Array& array : arrays) writer.Add("Float64", array.name, array.values);
  writer.AddXml(absl::StrCat("</", section, ">\n"));
}

template <typename Cells>
void WriteCells(const char* section, const Cells& cells, Writer& writer) {
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
  Writer writer;
  writer.AddXml(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n<PolyData>\n<FieldData>\n");
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
