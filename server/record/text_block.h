// Text that goes to a sink in blocks.
#ifndef PHRENIC_SERVER_RECORD_TEXT_BLOCK_H_
#define PHRENIC_SERVER_RECORD_TEXT_BLOCK_H_

#include <charconv>
#include <string>
#include <string_view>

#include "absl/strings/numbers.h"
#include "absl/strings/str_format.h"
#include "server/record/recorder.h"

namespace phrenic::record {

// Gathers text and hands it on in blocks of about 64 KiB. After the sink's first error nothing more is handed on.
class TextBlock {
 public:
  explicit TextBlock(Sink sink) : sink_(std::move(sink)) {}

  template <typename... Args>
  void Append(const absl::FormatSpec<Args...>& format, const Args&... args) {
    absl::StrAppendFormat(&text_, format, args...);
    if (text_.size() >= kBlock) (void)Flush();
  }

  // A number as "%.*g" writes it, and a character behind it; several times as fast.
  void AppendNumber(double number, int digits, char behind) {
    char text[48];
    const auto end = std::to_chars(text, text + sizeof text, number, std::chars_format::general, digits).ptr;
    text_.append(text, end);
    Put(behind);
  }

  void AppendInteger(std::int64_t integer, char behind) {
    char text[24];
    text_.append(text, std::to_chars(text, text + sizeof text, integer).ptr);
    Put(behind);
  }

  void Put(char character) {
    text_ += character;
    if (text_.size() >= kBlock) (void)Flush();
  }

  // Hands on what there is; the first error of all.
  absl::Status Flush() {
    if (status_.ok() && !text_.empty()) status_ = sink_(text_);
    text_.clear();
    return status_;
  }
  const absl::Status& status() const { return status_; }

 private:
  static constexpr size_t kBlock = 64 * 1024;
  Sink sink_;
  std::string text_;
  absl::Status status_;
};

}  // namespace phrenic::record

#endif  // PHRENIC_SERVER_RECORD_TEXT_BLOCK_H_
