// A cursor over the numbers of a block-structured MSH file, text or binary.
#ifndef PHRENIC_SERVER_MESHIO_MSH_VALUES_H_
#define PHRENIC_SERVER_MESHIO_MSH_VALUES_H_

#include <cstdint>
#include <string>
#include <string_view>

#include "absl/status/status.h"
#include "server/meshio/bytes.h"
#include "server/meshio/text.h"

namespace phrenic::meshio {

// Section names, and the counts of version 2, are text in binary files too. Methods that return bool return false at
// the end of the file or if the data does not fit. Holds views into `name` and `bytes`, which must outlive it. Not
// thread-safe. The parser of version 2 binary and of version 4.1 (msh_blocks.cc) uses it.
class MshValues {
 public:
  // Starts at byte `at`.
  MshValues(std::string_view name, std::string_view bytes, std::size_t at, bool binary);

  // Reads the int32 1 after the version line, from which the endianness of a binary file follows. Returns false if it
  // is 1 in neither byte order.
  bool TakeByteOrder();

  // Returns the next whitespace-separated word, also from later lines; empty at the end of the file.
  std::string Word();
  // Takes a word; true if it is `word`.
  bool Expect(std::string_view word) { return Word() == word; }
  // Reads a word as an integer, also in a binary file.
  bool TextInteger(std::int64_t& integer) { return ParseInteger(Word(), integer); }
  // Returns the rest of the line, or the next non-blank line, without surrounding blanks.
  std::string_view Line();
  // Moves to the start of binary data on the next line; the rest of the present line must be blank. No-op in text.
  bool StartBlock();
  // Moves past the next line that starts with `end`; `text` is what lies before that line. Returns false and moves
  // nowhere if there is no such line.
  bool TakeUntil(const std::string& end, std::string_view& text);

  // Read an int32, an int64 and a float64 in binary; a word in text.
  bool Int(std::int64_t& integer) { return binary_ ? TakeAs<std::int32_t>(integer) : TextInteger(integer); }
  bool Size(std::int64_t& integer) { return binary_ ? TakeAs<std::int64_t>(integer) : TextInteger(integer); }
  bool Double(double& number) { return binary_ ? TakeAs<double>(number) : ParseNumber(Word(), number); }

  // Returns INVALID_ARGUMENT "name:line: message" for text, "name:byte N: message" for binary. The line is that of the
  // last word, the byte that of the next one.
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
  std::size_t word_ = 0;  // start of the last word
  bool binary_;
  std::endian order_ = std::endian::little;
};

}  // namespace phrenic::meshio

#endif  // PHRENIC_SERVER_MESHIO_MSH_VALUES_H_
