#include "server/schema/placeholders.h"

#include "absl/strings/str_cat.h"

namespace phrenic::schema {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::Reflection;

constexpr std::size_t kLongestText = 1024;
constexpr int kThoracic = 12, kLumbar = 5;  // vertebrae
constexpr char kTooLarge[] = "for_each makes more than 16 MiB: repeat a smaller element";

std::string Braced(std::string_view word) { return absl::StrCat("{", std::string(word), "}"); }

}  // namespace

std::optional<Problem> Placeholders::Fill(const Repetition& repetition, Message* element, std::vector<PathStep>& path) {
  const std::size_t size = element->ByteSizeLong();
  if (size > bytes_left_) return Problem{path, kTooLarge};
  bytes_left_ -= size;
  return FillNested(repetition, element, path);
}

std::optional<Problem> Placeholders::FillNested(const Repetition& repetition, Message* message,
                                                std::vector<PathStep>& path) {
  const Reflection& reflection = *message->GetReflection();
  std::vector<const FieldDescriptor*> fields;
  reflection.ListFields(*message, &fields);
  for (const FieldDescriptor* field : fields) {
    const bool text = field->type() == FieldDescriptor::TYPE_STRING;
    if (!text && field->cpp_type() != FieldDescriptor::CPPTYPE_MESSAGE) continue;
    const int count = field->is_repeated() ? reflection.FieldSize(*message, field) : 1;
    for (int i = 0; i < count; ++i) {
      path.push_back({field, field->is_repeated() ? i : -1});
      if (text) {
        std::string value = field->is_repeated() ? reflection.GetRepeatedString(*message, field, i)
                                                 : reflection.GetString(*message, field);
        if (auto what = FillText(repetition, value)) return Problem{path, *what};
        field->is_repeated() ? reflection.SetRepeatedString(message, field, i, std::move(value))
                             : reflection.SetString(message, field, std::move(value));
      } else if (auto problem = FillNested(repetition,
                                           field->is_repeated() ? reflection.MutableRepeatedMessage(message, field, i)
                                                                : reflection.MutableMessage(message, field),
                                           path)) {
        return problem;
      }
      path.pop_back();
    }
  }
  return std::nullopt;
}

std::optional<std::string> Placeholders::FillText(const Repetition& repetition, std::string& text) {
  std::size_t open = text.find('{');
  if (open == std::string::npos) return std::nullopt;
  std::string filled;
  std::size_t done = 0;
  for (; open != std::string::npos; open = text.find('{', done)) {
    const std::size_t close = text.find('}', open);
    if (close == std::string::npos) return "a \"{\" has no \"}\" after it";
    filled.append(text, done, open - done);
    const std::string_view word = std::string_view(text).substr(open + 1, close - open - 1);
    if (auto what = Append(repetition, word, filled)) return what;
    done = close + 1;
    if (filled.size() > kLongestText) return absl::StrCat("is longer than ", kLongestText, " bytes when filled in");
  }
  filled.append(text, done);
  if (filled.size() > bytes_left_) return kTooLarge;
  bytes_left_ -= filled.size();
  text = std::move(filled);
  return std::nullopt;
}

std::optional<std::string> Placeholders::Append(const Repetition& repetition, std::string_view word, std::string& out) {
  if (word == "side") {
    side_ = true;
    if (repetition.side == v1::SIDE_UNSPECIFIED) return "says {side}, and its for_each has no sides";
    out += repetition.side == v1::SIDE_RIGHT ? "right" : "left";
    return std::nullopt;
  }
  if (word == "value") {
    value_ = true;
    if (repetition.value == nullptr) return "says {value}, and its for_each has no values";
    out += *repetition.value;
    return std::nullopt;
  }
  return AppendNumber(repetition, word, out);
}

std::optional<std::string> Placeholders::AppendNumber(const Repetition& repetition, std::string_view word,
                                                      std::string& out) {
  if (word != "number" && word != "number-1" && word != "vertebra") {
    return absl::StrCat("there is no ", Braced(word.substr(0, 32)),
                        ": write {number}, {number-1}, {side}, {vertebra} or {value}");
  }
  number_ = true;
  if (!repetition.number) return absl::StrCat("says ", Braced(word), ", and its for_each has no numbers");
  const int number = *repetition.number;
  if (word != "vertebra") {
    absl::StrAppend(&out, word == "number" ? number : number - 1);
    return std::nullopt;
  }
  if (number < 1 || number > kThoracic + kLumbar) {
    return absl::StrCat("there is no vertebra ", number, ": thoracic ones are 1 to 12, lumbar ones 13 to 17");
  }
  absl::StrAppend(&out, number <= kThoracic ? "t" : "l", number <= kThoracic ? number : number - kThoracic);
  return std::nullopt;
}

std::string Placeholders::Unused(const v1::ForEach& each) const {
  if (value_) return "";
  if (each.values_size() > 0) return "has values, and no text of the element says {value}";
  if (each.numbers().first() < each.numbers().last() && !number_) {
    return "has numbers, and no text of the element says {number}";
  }
  return each.sides_size() > 1 && !side_ ? "has sides, and no text of the element says {side}" : "";
}

}  // namespace phrenic::schema
