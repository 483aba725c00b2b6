// Builds VTK's XML files with raw appended data, each array compressed by zlib, little-endian (VTK File Formats, "XML
// File Formats").
#ifndef PHRENIC_SERVER_VTK_XML_WRITER_H_
#define PHRENIC_SERVER_VTK_XML_WRITER_H_

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"

namespace phrenic {

// Returns the text with &, <, > and quotes escaped.
std::string XmlEscaped(const std::string& text);

// The XML text and the appended binary data, built side by side. Not thread-safe.
class XmlWriter {
 public:
  // `type` is VTK's: "PolyData", "ImageData".
  explicit XmlWriter(const char* type);

  // Adds a DataArray: one tuple per column of `values`.
  template <typename Derived>
  void Add(const char* type, const std::string& name, const Eigen::MatrixBase<Derived>& values) {
    const typename Derived::PlainObject plain = values;
    absl::StrAppend(&head_, "<DataArray type=\"", type, "\" Name=\"", XmlEscaped(name), "\" NumberOfComponents=\"",
                    plain.rows(), "\" format=\"appended\" offset=\"", appended_.size(), "\"/>\n");
    Append(plain.data(), sizeof(typename Derived::Scalar) * static_cast<std::size_t>(plain.size()));
  }
  // Adds a String array: the character codes of each text, ended by 0.
  void AddText(const std::string& name, const std::vector<std::string>& texts);
  void AddXml(const std::string& text) { head_ += text; }
  std::string Finish() &&;

 private:
  void Append(const void* bytes, std::size_t size);
  void AppendHeader(std::initializer_list<std::uint64_t> numbers);

  std::string head_, appended_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_VTK_XML_WRITER_H_
