#include <google/protobuf/io/tokenizer.h>
#include <google/protobuf/text_format.h>

#include "absl/strings/str_cat.h"
#include "server/schema/aliases.h"
#include "server/schema/problem.h"
#include "server/schema/repetition.h"
#include "server/schema/schema.h"

namespace phrenic::schema {
namespace {

using google::protobuf::TextFormat;

constexpr int kDeepestNesting = 32;  // levels of messages; a scene needs five

std::string LineAndColumn(const std::string& name, int line, int column) {
  return absl::StrCat(name, ":", line + 1, ":", column + 1, ": ");
}

// Keeps the first error of a parse; later ones mostly follow from it.
class FirstError : public google::protobuf::io::ErrorCollector {
 public:
  explicit FirstError(std::string name) : name_(std::move(name)) {}
  void AddError(int line, int column, const std::string& message) override {
    if (text_.empty()) text_ = absl::StrCat(LineAndColumn(name_, line, column), message);
  }
  void AddWarning(int, int, const std::string&) override {}
  const std::string& text() const { return text_; }

 private:
  std::string name_;
  std::string text_;
};

// Where in a text each field was set.
class Locations {
 public:
  explicit Locations(std::string name) : name_(std::move(name)) {}
  TextFormat::ParseInfoTree* tree() { return &tree_; }

  // INVALID_ARGUMENT "name:line:column: path: what". A field that the text does not set has the line of the message
  // that lacks it.
  absl::Status Error(const Problem& problem) const {
    const TextFormat::ParseInfoTree* tree = &tree_;
    TextFormat::ParseLocation found;
    for (const PathStep& step : problem.path) {
      const bool whole_list = step.field->is_repeated() && step.index < 0;
      const int index = whole_list ? 0 : step.index;
      const google::protobuf::FieldDescriptor* field =
          tree == nullptr ? nullptr : NameInText(*tree, *step.field, index);
      if (field == nullptr) break;
      found = tree->GetLocation(field, index);
      tree = whole_list ? nullptr : tree->GetTreeForNested(field, index);
    }
    const std::string place =
        found.line < 0 ? absl::StrCat(name_, ": ") : LineAndColumn(name_, found.line, found.column);
    return absl::InvalidArgumentError(absl::StrCat(place, FormatPath(problem.path), ": ", problem.what));
  }

 private:
  // Returns `field` or the older name of it, whichever the text has; null if it has neither.
  static const google::protobuf::FieldDescriptor* NameInText(const TextFormat::ParseInfoTree& tree,
                                                             const google::protobuf::FieldDescriptor& field,
                                                             int index) {
    if (tree.GetLocation(&field, index).line >= 0) return &field;
    for (const auto* alias : AliasesOf(field)) {
      if (tree.GetLocation(alias, index).line >= 0) return alias;
    }
    return nullptr;
  }

  std::string name_;
  TextFormat::ParseInfoTree tree_;
};

absl::Status Parse(const std::string& name, const std::string& text, google::protobuf::Message* message,
                   Locations& locations) {
  FirstError error(name);
  TextFormat::Parser parser;
  parser.RecordErrorsTo(&error);
  parser.WriteLocationsTo(locations.tree());
  parser.SetRecursionLimit(kDeepestNesting);
  if (!parser.ParseFromString(text, message)) {
    return absl::InvalidArgumentError(absl::StrCat(error.text(), " (the language is message ",
                                                   message->GetDescriptor()->name(), " of proto/phrenic/v1)"));
  }
  if (const auto problem = MoveAliases(message)) return locations.Error(*problem);
  if (const auto problem = FindProblem(*message)) return locations.Error(*problem);
  return absl::OkStatus();
}

}  // namespace

absl::Status ParseText(std::string_view name, const std::string& text, google::protobuf::Message* message) {
  Locations locations{std::string(name)};
  return Parse(std::string(name), text, message, locations);
}

absl::StatusOr<v1::Scene> ParseScene(std::string_view name, const std::string& text) {
  v1::Scene scene;
  Locations locations{std::string(name)};
  if (absl::Status status = Parse(std::string(name), text, &scene, locations); !status.ok()) return status;
  if (const auto problem = Repeat(&scene)) return locations.Error(*problem);
  return scene;
}

}  // namespace phrenic::schema
