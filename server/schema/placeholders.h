// Words in braces in the texts of an element that is repeated: "{number}", "{side}", "{vertebra}", "{value}".
#ifndef PHRENIC_SERVER_SCHEMA_PLACEHOLDERS_H_
#define PHRENIC_SERVER_SCHEMA_PLACEHOLDERS_H_

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "phrenic/v1/geometry.pb.h"
#include "server/schema/problem.h"

namespace phrenic::schema {

// What the words stand for in one repetition.
struct Repetition {
  std::optional<int> number = std::nullopt;
  v1::Side side = v1::SIDE_UNSPECIFIED;
  const std::string* value = nullptr;
};

// Fills the placeholders of one element's repetitions. `bytes_left` bounds the size of all of them together.
class Placeholders {
 public:
  explicit Placeholders(std::size_t& bytes_left) : bytes_left_(bytes_left) {}

  // Replaces the placeholders in every text of `element`, a copy of the repeated one. `path` leads to the element.
  std::optional<Problem> Fill(const Repetition& repetition, google::protobuf::Message* element,
                              std::vector<PathStep>& path);
  // Why all repetitions are the same in a respect: a list of `each` that no text has named; empty if there is none.
  std::string Unused(const v1::ForEach& each) const;

 private:
  std::optional<Problem> FillNested(const Repetition& repetition, google::protobuf::Message* message,
                                    std::vector<PathStep>& path);
  std::optional<std::string> FillText(const Repetition& repetition, std::string& text);
  // Appends what the word stands for; what is wrong with it otherwise.
  std::optional<std::string> Append(const Repetition& repetition, std::string_view word, std::string& out);
  std::optional<std::string> AppendNumber(const Repetition& repetition, std::string_view word, std::string& out);

  std::size_t& bytes_left_;
  bool number_ = false, side_ = false, value_ = false;  // has a text named it
};

}  // namespace phrenic::schema

#endif  // PHRENIC_SERVER_SCHEMA_PLACEHOLDERS_H_
