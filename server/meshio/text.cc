#include "server/meshio/text.h"

#include <charconv>
#include <cmath>
#include <cstring>

#include "absl/strings/str_cat.h"

namespace phrenic::meshio {
namespace {

bool IsBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

// std::from_chars does not accept a leading "+".
std::string_view WithoutPlus(std::string_view word) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  return word;
}

template <typename T>
bool ParseWord(std::string_view word, T& value) {
  word = WithoutPlus(word);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size();
}

}  // namespace

bool TextReader::NextLine() {
  if (next_ >= bytes_.size()) return false;
  at_ = next_;
  const auto* newline = static_cast<const char*>(std::memchr(bytes_.data() + at_, '\n', bytes_.size() - at_));
  end_ = newline == nullptr ? bytes_.size() : static_cast<std::size_t>(newline - bytes_.data());
  next_ = newline == nullptr ? bytes_.size() : end_ + 1;
  ++line_;
  return true;
}

bool TextReader::NextFilledLine() {
  while (NextLine()) {
    if (!Rest().empty()) return true;
  }
  return false;
}

void TextReader::JoinContinuedLine() {
  const std::size_t start = at_;
  while (end_ > start) {
    const bool carriage_return = end_ - start >= 2 && bytes_[end_ - 1] == '\r';
    const std::size_t last = end_ - (carriage_return ? 2 : 1);
    if (bytes_[last] != '\\' || !NextLine()) break;
  }
  at_ = start;
}

std::string_view TextReader::Rest() const {
  std::size_t first = at_;
  std::size_t last = end_;
  while (first < last && IsBlank(bytes_[first])) ++first;
  while (last > first && IsBlank(bytes_[last - 1])) --last;
  return bytes_.substr(first, last - first);
}

std::string_view TextReader::Word() {
  // In a joined line, the continuation backslash and the newline count as blanks.
  const auto blank = [this](std::size_t i) {
    return IsBlank(bytes_[i]) || bytes_[i] == '\n' || (bytes_[i] == '\\' && (i + 1 == end_ || bytes_[i + 1] <= ' '));
  };
  while (at_ < end_ && blank(at_)) ++at_;
  const std::size_t first = at_;
  while (at_ < end_ && !blank(at_)) ++at_;
  return bytes_.substr(first, at_ - first);
}

bool TextReader::Number(double& number) { return ParseNumber(Word(), number); }

bool TextReader::Integer(std::int64_t& integer) { return ParseWord(Word(), integer); }

absl::Status TextReader::ErrorAt(int line, const std::string& message) const {
  return absl::InvalidArgumentError(absl::StrCat(std::string(name_), ":", line, ": ", message));
}

std::string Quoted(std::string_view word) {
  constexpr std::size_t kMaxLength = 32;
  std::string quoted = "\"";
  for (char c : word.substr(0, kMaxLength)) quoted += (c >= ' ' && c <= '~') ? c : '?';
  quoted += word.size() > kMaxLength ? "...\"" : "\"";
  return quoted;
}

bool ParseInteger(std::string_view word, std::int64_t& integer) { return ParseWord(word, integer); }

bool ParseNumber(std::string_view word, double& number) { return ParseWord(word, number) && std::isfinite(number); }

void AppendNumber(std::string& text, double number) {
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof(digits), number).ptr;
  text += ' ';
  text.append(digits, end);
}

}  // namespace phrenic::meshio
