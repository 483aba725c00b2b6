#include "client/print/field.h"

#include <utility>
#include <vector>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "server/schema/names.h"

namespace phrenic::client {
namespace {

using nlohmann::json;

std::string TextOf(const json& value) {
  if (value.is_string()) return value.get<std::string>();
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

// Selects values step by step along a path.
class FieldSearch {
 public:
  explicit FieldSearch(std::string path) : path_(std::move(path)), steps_(absl::StrSplit(path_, '.')) {}

  absl::Status Take(const json& value, std::size_t at) {
    if (at == steps_.size()) {
      absl::StrAppend(&text_, TextOf(value), "\n");
      return absl::OkStatus();
    }
    if (value.is_array()) return TakeElements(value, at);
    if (!value.is_object()) return Fault(at, "is a single value");
    const auto member = value.find(steps_[at]);
    if (member != value.end()) return Take(*member, at + 1);
    std::vector<std::string> names;
    for (const auto& [name, each] : value.items()) names.push_back(name);
    return Fault(at, absl::StrCat("has no member ", steps_[at], schema::ThereAre(steps_[at], names)));
  }

  const std::string& text() const { return text_; }

 private:
  absl::Status TakeElements(const json& list, std::size_t at) {
    std::size_t index = 0;
    if (steps_[at] == "*") {
      for (const json& each : list) {
        if (absl::Status status = Take(each, at + 1); !status.ok()) return status;
      }
      return absl::OkStatus();
    }
    if (!absl::SimpleAtoi(steps_[at], &index) || index >= list.size()) {
      return Fault(at, absl::StrCat("is a list of ", list.size(), ": its steps are *, and indices from 0"));
    }
    return Take(list[index], at + 1);
  }

  // `what` is wrong with the value that the steps before `at` lead to.
  absl::Status Fault(std::size_t at, const std::string& what) const {
    const std::vector<std::string> before(steps_.begin(), steps_.begin() + static_cast<std::ptrdiff_t>(at));
    const std::string where = before.empty() ? "the output" : absl::StrJoin(before, ".");
    return absl::InvalidArgumentError(absl::StrCat("--field ", path_, ": ", where, " ", what));
  }

  const std::string path_;
  const std::vector<std::string> steps_;
  std::string text_;
};

// Receives what a command prints, and hands each document to a function.
class Documents : public std::streambuf {
 public:
  Documents(bool by_lines, std::function<void(const std::string&)> take)
      : by_lines_(by_lines), take_(std::move(take)) {}

  // Hands over what is left.
  void Finish() {
    if (!text_.empty()) take_(std::exchange(text_, ""));
  }

 protected:
  int_type overflow(int_type c) override {
    if (c == traits_type::eof()) return traits_type::not_eof(c);
    text_.push_back(traits_type::to_char_type(c));
    if (by_lines_ && text_.back() == '\n') Finish();
    return c;
  }

 private:
  const bool by_lines_;
  const std::function<void(const std::string&)> take_;
  std::string text_;
};

}  // namespace

absl::StatusOr<std::string> FieldOf(const json& document, const std::string& path) {
  FieldSearch search(path);
  if (absl::Status status = search.Take(document, 0); !status.ok()) return status;
  return search.text();
}

absl::Status PrintField(std::ostream& out, const std::string& path, bool by_lines,
                        const std::function<void()>& command) {
  std::ostream printed(out.rdbuf());
  absl::Status status;
  Documents documents(by_lines, [&](const std::string& text) {
    if (!status.ok()) return;
    const json document = json::parse(text, nullptr, /*allow_exceptions=*/false);
    if (document.is_discarded()) {
      status = absl::InvalidArgumentError(absl::StrCat("--field ", path, ": the command's output is not JSON"));
      return;
    }
    const auto field = FieldOf(document, path);
    status = field.status();
    if (field.ok()) printed << *field << std::flush;
  });
  std::streambuf* const before = out.rdbuf(&documents);
  command();
  out.rdbuf(before);
  documents.Finish();
  return status;
}

}  // namespace phrenic::client
