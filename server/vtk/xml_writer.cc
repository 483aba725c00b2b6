#include "server/vtk/xml_writer.h"

#include <zlib.h>

#include <bit>

#include "absl/strings/str_replace.h"

namespace phrenic {
namespace {

static_assert(std::endian::native == std::endian::little, "the file declares byte_order LittleEndian");

constexpr int kLevel = 1;  // zlib's fastest; higher levels barely shrink coordinates further

}  // namespace

std::string XmlEscaped(const std::string& text) {
  return absl::StrReplaceAll(text, {{"&", "&amp;"}, {"<", "&lt;"}, {">", "&gt;"}, {"\"", "&quot;"}});
}

XmlWriter::XmlWriter(const char* type)
    : head_(absl::StrCat("<?xml version=\"1.0\"?>\n<VTKFile type=\"", type,
                         "\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\" "
                         "compressor=\"vtkZLibDataCompressor\">\n")) {}

void XmlWriter::AddText(const std::string& name, const std::vector<std::string>& texts) {
  absl::StrAppend(&head_, "<Array type=\"String\" Name=\"", name, "\" NumberOfTuples=\"", texts.size(),
                  "\" format=\"ascii\">");
  for (const std::string& text : texts) {
    for (const char character : text) absl::StrAppend(&head_, static_cast<unsigned char>(character), " ");
    head_ += "0 ";
  }
  head_ += "</Array>\n";
}

std::string XmlWriter::Finish() && {
  return absl::StrCat(head_, "<AppendedData encoding=\"raw\">\n_", appended_, "\n</AppendedData>\n</VTKFile>\n");
}

// Appends a compressed array of one block: header (number of blocks, uncompressed block size, size of a partial last
// block or 0, compressed size), then the zlib stream.
void XmlWriter::Append(const void* bytes, std::size_t size) {
  if (size == 0) return AppendHeader({0, 0, 0});
  uLongf packed = compressBound(size);
  std::string block(packed, '\0');
  compress2(reinterpret_cast<Bytef*>(block.data()), &packed, static_cast<const Bytef*>(bytes), size, kLevel);
  AppendHeader({1, size, 0, packed});
  appended_.append(block, 0, packed);
}

void XmlWriter::AppendHeader(std::initializer_list<std::uint64_t> numbers) {
  for (const std::uint64_t number : numbers) {
    appended_.append(reinterpret_cast<const char*>(&number), sizeof number);
  }
}

}  // namespace phrenic
