#include <google/protobuf/io/tokenizer.h>
#include <google/protobuf/text_format.h>

#include "absl/strings/str_cat.h"
#include "server/schema/problem.h"
#include "server/schema/schema.h"

namespace phrenic::schema {
namespace {

using google::protobuf::TextFormat;

constexpr int kDeepestNesting = 32;  // of messages; a scene needs five

std::string Place(const std::string& name, int line, int column) {
  return absl::StrCat(name, ":", line + 1, ":", column + 1, ": ");
}

// Keeps the first error of a parse; the ones after it mostly follow from it.
class FirstError : public google::protobuf::io::ErrorCollector {
 public:
  explicit FirstError(std::string name) : name_(std::move(name)) {}
  void AddError(int line, int column, const std::string& message) override {
    if (text_.empty()) text_ = absl::StrCat(Place(name_, line, column), message);
  }
  void AddWarning(int, int, const std::string&) override {}
  const std::string& text() const { return text_; }

 private:
  std::string name_;
  std::string text_;
};

// Where the text set the problem's field; a field that it did not set is placed at the message that lacks it.
std::string PlaceOf(const Problem& problem, const std::string& name, TextFormat::ParseInfoTree* tree) {
  TextFormat::ParseLocation found;
  for (const PathStep& step : problem.path) {
    if (tree == nullptr || (step.field->is_repeated() && step.index < 0)) break;
    const TextFormat::ParseLocation here = tree->GetLocation(step.field, step.index);
    if (here.line < 0) break;
    found = here;
    tree = tree->GetTreeForNested(step.field, step.index);
  }
  return found.line < 0 ? absl::StrCat(name, ": ") : Place(name, found.line, found.column);
}

}  // namespace

absl::Status ParseText(std::string_view name, const std::string& text, google::protobuf::Message* message) {
  const std::string file(name);
  FirstError error(file);
  TextFormat::ParseInfoTree tree;
  TextFormat::Parser parser;
  parser.RecordErrorsTo(&error);
  parser.WriteLocationsTo(&tree);
  parser.SetRecursionLimit(kDeepestNesting);
  if (!parser.ParseFromString(text, message)) {
    return absl::InvalidArgumentError(absl::StrCat(error.text(), " (the language is message ",
                                                   message->GetDescriptor()->name(), " of proto/phrenic/v1)"));
  }
  if (const std::optional<Problem> problem = FindProblem(*message)) {
    return absl::InvalidArgumentError(
        absl::StrCat(PlaceOf(*problem, file, &tree), FormatPath(problem->path), ": ", problem->what));
  }
  return absl::OkStatus();
}

absl::StatusOr<v1::Scene> ParseScene(std::string_view name, const std::string& text) {
  v1::Scene scene;
  if (absl::Status status = ParseText(name, text, &scene); !status.ok()) return status;
  return scene;
}

}  // namespace phrenic::schema
