// Walks over the bytes of a text file, line by line and word by word, without copying them.
#ifndef PHRENIC_SERVER_MESHIO_TEXT_H_
#define PHRENIC_SERVER_MESHIO_TEXT_H_

#include <cstdint>
#include <string>
#include <string_view>

#include "absl/status/status.h"

namespace phrenic::meshio {

// Lines end at "\n" or "\r\n"; words are separated by spaces and tabs. Holds views into `bytes`, which must outlive it.
// Not thread-safe.
class TextReader {
 public:
  TextReader(std::string_view name, std::string_view bytes) : name_(name), bytes_(bytes) {}

  // Moves to the next line; false after the last one.
  bool NextLine();
  // Moves to the next line that has a word; false when there is none left.
  bool NextFilledLine();
  // A line whose last character is "\" goes on in the next one (OBJ); call right after NextLine.
  void JoinContinuedLine();

  // What is left of the present line, without surrounding blanks.
  std::string_view Rest() const;
  // Takes the next word of the line; empty at its end.
  std::string_view Word();
  // Takes the next word as a number; false when it is none, or not finite, or there is no word left.
  bool Number(double& number);
  bool Integer(std::int64_t& integer);

  // Where the line after the present one starts [bytes from the first].
  std::size_t next_line() const { return next_; }
  // Number of the present line, from 1.
  int line() const { return line_; }
  // INVALID_ARGUMENT "name:line: message".
  absl::Status Error(const std::string& message) const { return ErrorAt(line_, message); }
  absl::Status ErrorAt(int line, const std::string& message) const;

 private:
  std::string_view name_;
  std::string_view bytes_;
  std::size_t next_ = 0;  // start of the line after the present one
  std::size_t at_ = 0;    // the reading place in the present line
  std::size_t end_ = 0;   // end of the present line
  int line_ = 0;
};

// The word as it may stand in an error message: quoted, short and printable.
std::string Quoted(std::string_view word);

// Takes a whole word as an integer, or as a finite number.
bool ParseInteger(std::string_view word, std::int64_t& integer);
bool ParseNumber(std::string_view word, double& number);

// Adds a blank and the shortest text that reads back as the same number.
void AppendNumber(std::string& text, double number);

}  // namespace phrenic::meshio

#endif  // PHRENIC_SERVER_MESHIO_TEXT_H_
