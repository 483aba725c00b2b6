// A cursor over a text file by lines and words, and number conversion. Nothing depends on the locale.
#ifndef PHRENIC_SERVER_MESHIO_TEXT_H_
#define PHRENIC_SERVER_MESHIO_TEXT_H_

#include <cstdint>
#include <string>
#include <string_view>

#include "absl/status/status.h"

namespace phrenic::meshio {

// Lines end with "\n" or "\r\n"; words are separated by blanks. Holds views into `name` and `bytes`, which must outlive
// it, and copies nothing. Not thread-safe. Copies are independent cursors.
class TextReader {
 public:
  TextReader(std::string_view name, std::string_view bytes) : name_(name), bytes_(bytes) {}

  // Moves to the next line. Returns false after the last one.
  bool NextLine();
  // Moves to the next line that is not blank. Returns false if there is none.
  bool NextFilledLine();
  // Joins the line with the next ones while it ends in "\" (OBJ). Call right after NextLine.
  void JoinContinuedLine();

  // Returns the rest of the line without surrounding blanks.
  std::string_view Rest() const;
  // Reads the next word of the line; empty at its end.
  std::string_view Word();
  // Reads the next word as a finite number. Returns false if it is not one or the line has ended. A "+" before a number
  // is accepted, here and in Integer.
  bool Number(double& number);
  bool Integer(std::int64_t& integer);

  // Byte offset of the next line.
  std::size_t next_line() const { return next_; }
  // Number of the current line, from 1; 0 before the first. A joined line has the number of its last one.
  int line() const { return line_; }
  // Returns INVALID_ARGUMENT "name:line: message".
  absl::Status Error(const std::string& message) const { return ErrorAt(line_, message); }
  // The same for another line.
  absl::Status ErrorAt(int line, const std::string& message) const;

 private:
  std::string_view name_;
  std::string_view bytes_;
  std::size_t next_ = 0;  // start of the next line
  std::size_t at_ = 0;    // position in the current line
  std::size_t end_ = 0;   // end of the current line
  int line_ = 0;
};

// Returns the word for an error message: quoted, truncated to 32 characters, unprintable ones replaced by "?".
std::string Quoted(std::string_view word);

// Parse the entire word as an integer, and as a finite number. Return false if that fails. Numbers are those of
// std::from_chars, with a "+" allowed; "nan" and "inf" are refused.
bool ParseInteger(std::string_view word, std::int64_t& integer);
bool ParseNumber(std::string_view word, double& number);

// Appends a blank and the shortest text that parses back to the same number.
void AppendNumber(std::string& text, double number);

}  // namespace phrenic::meshio

#endif  // PHRENIC_SERVER_MESHIO_TEXT_H_
