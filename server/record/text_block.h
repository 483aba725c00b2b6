// Buffered text output to a sink.
#ifndef PHRENIC_SERVER_RECORD_TEXT_BLOCK_H_
#define PHRENIC_SERVER_RECORD_TEXT_BLOCK_H_

#include <charconv>
#include <string>
#include <string_view>

#include "absl/strings/numbers.h"
#include "absl/strings/str_format.h"
#include "server/record/recorder.h"

namespace phrenic::record {

// Collects text and passes it to the sink in blocks of about 64 KiB. Stops passing text after the sink's first error.
// Not thread-safe. Recorders of text formats own one. Nothing depends on the locale.
class TextBlock {
 public:
  explicit TextBlock(Sink sink) : sink_(std::move(sink)) {}

  // Appends formatted text (absl::StrAppendFormat). An error of the sink shows in status() and Flush.
  template <typename... Args>
  void Append(const absl::FormatSpec<Args...>& format, const Args&... args) {
    absl::StrAppendFormat(&text_, format, args...);
    if (text_.size() >= kBlock) (void)Flush();
  }

  // Appends a number as "%.*g" formats it, and the character `after`. Several times as fast as Append. Requires: digits
  // <= 30.
  void AppendNumber(double number, int digits, char after) {
    char text[48];
    const auto end = std::to_chars(text, text + sizeof text, number, std::chars_format::general, digits).ptr;
    text_.append(text, end);
    Put(after);
  }

  // Appends an integer in decimal digits, and the character `after`.
  void AppendInteger(std::int64_t integer, char after) {
    char text[24];
    text_.append(text, std::to_chars(text, text + sizeof text, integer).ptr);
    Put(after);
  }

  void Put(char character) {
    text_ += character;
    if (text_.size() >= kBlock) (void)Flush();
  }

  // Passes the rest to the sink. Returns the sink's first error so far.
  absl::Status Flush() {
    if (status_.ok() && !text_.empty()) status_ = sink_(text_);
    text_.clear();
    return status_;
  }
  // Returns the sink's first error so far, without passing on the rest.
  const absl::Status& status() const { return status_; }

 private:
  static constexpr size_t kBlock = 64 * 1024;  // [bytes]
  Sink sink_;
  std::string text_;  // not passed to the sink yet
  absl::Status status_;
};

}  // namespace phrenic::record

#endif  // PHRENIC_SERVER_RECORD_TEXT_BLOCK_H_
