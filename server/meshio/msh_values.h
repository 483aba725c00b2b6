// The numbers of an MSH file in blocks, one after the other, whether they stand in text or in binary.
#ifndef PHRENIC_SERVER_MESHIO_MSH_VALUES_H_
#define PHRENIC_SERVER_MESHIO_MSH_VALUES_H_

#include <cstdint>
#include <string>
#include <string_view>

#include "absl/status/status.h"
#include "server/meshio/bytes.h"
#include "server/meshio/text.h"

namespace phrenic::meshio {

// Sections' names and counts of version 2 are words of text in either kind of file. Holds views into `bytes`. Every
// bool is false where nothing more, or nothing fitting, is there.
class MshValues {
 public:
  MshValues(std::string_view name, std::string_view bytes, std::size_t at, bool binary);

  // The number 1 after $MeshFormat's line, by which a binary file tells its byte order.
  bool TakeByteOrder();

  // The next word of text, over ends of lines; empty at the file's end.
  std::string Word();
  bool Expect(std::string_view word) { return Word() == word; }
  bool TextInteger(std::int64_t& integer) { return ParseInteger(Word(), integer); }
  // What is left of the line, or the next line that has a word, without surrounding blanks.
  std::string_view Line();
  // In a binary file the numbers after a word start on the next line, and there is nothing but blanks before it.
  bool StartBlock();
  // Goes to the line after the one that is `end`.
  bool PassOver(const std::string& end);

  // Four bytes, eight bytes, and eight bytes of a float64; words in text.
  bool Int(std::int64_t& integer) { return binary_ ? TakeAs<std::int32_t>(integer) : TextInteger(integer); }
  bool Size(std::int64_t& integer) { return binary_ ? TakeAs<std::int64_t>(integer) : TextInteger(integer); }
  bool Double(double& number) { return binary_ ? TakeAs<double>(number) : ParseNumber(Word(), number); }

  // INVALID_ARGUMENT "name:line: message", or "name:byte N: message" of a binary file.
  absl::Status Error(const std::string& message) const;

 private:
  template <typename T, typename Number>
  bool TakeAs(Number& number) {
    ByteReader reader(name_, bytes_, at_, order_);
    T raw{};
    if (!reader.Take(raw)) return false;
    at_ = reader.at();
    number = raw;
    return true;
  }

  std::string_view name_, bytes_;
  std::size_t at_;
  std::size_t word_ = 0;  // where the last word starts
  bool binary_;
  std::endian order_ = std::endian::little;
};

}  // namespace phrenic::meshio

#endif  // PHRENIC_SERVER_MESHIO_MSH_VALUES_H_
