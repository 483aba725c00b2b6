#include "server/record/csv.h"

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "server/record/text_block.h"

namespace phrenic::record {
namespace {

constexpr int kTimeDigits = 12, kNumberDigits = 9;

// Returns a cell by RFC 4180: quoted if necessary, with line breaks replaced by blanks.
std::string Cell(const std::string& text) {
  std::string line = absl::StrReplaceAll(text, {{"\n", " "}, {"\r", " "}});
  if (line.find_first_of(",\"") == std::string::npos) return line;
  return absl::StrCat("\"", absl::StrReplaceAll(line, {{"\"", "\"\""}}), "\"");
}

class CsvRecorder final : public Recorder {
 public:
  explicit CsvRecorder(Settings settings) : text_(std::move(settings.sink)) {}

  absl::Status Begin(const Recording& recording) override {
    text_.Append("time [s]");
    for (const Column& column : recording.columns) {
      text_.Append(",%s", Cell(absl::StrCat(column.name, " [", column.unit, "]")));
    }
    text_.Put('\n');
    return text_.Flush();
  }

  absl::Status AddFrame(const RecordedFrame& frame) override {
    text_.AppendNumber(frame.time, kTimeDigits, frame.numbers.empty() ? '\n' : ',');
    for (std::size_t i = 0; i < frame.numbers.size(); ++i) {
      text_.AppendNumber(frame.numbers[i], kNumberDigits, i + 1 < frame.numbers.size() ? ',' : '\n');
    }
    return text_.status();
  }

  absl::Status End(const std::function<absl::Status(double share)>& /*report*/) override { return text_.Flush(); }

 private:
  TextBlock text_;
};

}  // namespace

std::unique_ptr<Recorder> MakeCsvRecorder(Settings settings) {
  return std::make_unique<CsvRecorder>(std::move(settings));
}

}  // namespace phrenic::record
