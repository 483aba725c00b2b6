#include <google/protobuf/io/tokenizer.h>
#include <google/protobuf/text_format.h>

#include "absl/strings/str_cat.h"
#include "server/schema/schema.h"

namespace phrenic::schema {
namespace {

constexpr int kDeepestNesting = 32;  // of messages; a scene needs five

// Keeps the first error.
class FirstError : public google::protobuf::io::ErrorCollector {
 public:
  void AddError(int line, google::protobuf::io::ColumnNumber column, const std::string& message) override {
    if (text_.empty()) text_ = absl::StrCat(line + 1, ":", column + 1, ": ", message);
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

}  // namespace

absl::StatusOr<v1::Scene> ParseScene(std::string_view name, const std::string& text) {
  const std::string file(name);
  v1::Scene scene;
  FirstError error;
  google::protobuf::TextFormat::Parser parser;
  parser.RecordErrorsTo(&error);
  parser.SetRecursionLimit(kDeepestNesting);
  if (!parser.ParseFromString(text, &scene)) {
    return absl::InvalidArgumentError(
        absl::StrCat(file, ":", error.text(), " (the scene language is proto/phrenic/v1/scene.proto)"));
  }
  if (absl::Status status = Validate(scene); !status.ok()) {
    return absl::InvalidArgumentError(absl::StrCat(file, ": ", status.message()));
  }
  return scene;
}

}  // namespace phrenic::schema
