#include <algorithm>
#include <cctype>
#include <regex>

#include "tests/architecture/rules.h"

namespace phrenic::architecture {
namespace {

// The end of what starts at `i` and holds no code: a comment, a literal, a preprocessor line; `i` where it is code.
size_t SkipLiteral(std::string_view text, size_t i) {
  if (text.substr(i, 2) == "//") return std::min(text.find('\n', i), text.size());
  if (text.substr(i, 2) == "/*") return std::min(text.find("*/", i), text.size() - 2) + 2;
  if (text.substr(i, 2) == "R\"") {
    const size_t open = text.find('(', i);
    const std::string close = ")" + std::string(text.substr(i + 2, open - i - 2)) + "\"";
    return std::min(text.find(close, open), text.size() - close.size()) + close.size();
  }
  const bool separator = text[i] == '\'' && i > 0 && std::isalnum(static_cast<unsigned char>(text[i - 1])) != 0;
  if ((text[i] != '"' && text[i] != '\'') || separator) return i;
  size_t end = i + 1;
  while (end < text.size() && text[end] != text[i]) end += text[end] == '\\' ? 2 : 1;
  return std::min(end + 1, text.size());
}

size_t SkipDirective(std::string_view text, size_t i) {
  size_t end = i;
  do {
    end = std::min(text.find('\n', end), text.size() - 1) + 1;
  } while (end < text.size() && end >= 2 && text[end - 2] == '\\');
  return end - 1;
}

// The text with everything that is no code made blank; lines stay where they are.
std::string CodeOf(std::string_view text) {
  std::string code(text);
  bool line_start = true;
  for (size_t i = 0; i < text.size();) {
    const bool directive = line_start && text[i] == '#';
    const size_t end = directive ? SkipDirective(text, i) : SkipLiteral(text, i);
    for (size_t k = i; k < end; ++k) code[k] = text[k] == '\n' ? '\n' : ' ';
    if (end > i && !directive && (text[i] == '"' || text[i] == '\'' || text[i] == 'R')) code[i] = '0';
    line_start = text[i] == '\n' || (line_start && text[i] == ' ');
    i = std::max(end, i + 1);
  }
  return code;
}

bool OpensScope(const std::string& head) {
  static const std::regex scope(R"(\b(namespace|class|struct|union|enum)\b[^()=]*$)");
  static const std::regex linkage(R"(^\s*extern\s+0\s*$)");
  return std::regex_search(head, scope) || std::regex_search(head, linkage);
}

bool OpensFunction(const std::string& head) {
  const size_t last = head.find_last_not_of(" \n\t");
  return head.find('(') != std::string::npos && last != std::string::npos && head[last] != '=' && head[last] != '(';
}

// Reads code brace by brace; a function is an outermost block that is no scope and no list of values.
class Reader {
 public:
  explicit Reader(const std::string& code) : code_(code) {}

  std::vector<Function> Read() {
    for (; next_ < code_.size(); ++next_) {
      const char c = code_[next_];
      if (c == '\n') ++line_;
      if (depth_ > 0) {
        Inside(c);
      } else if (c == '{') {
        Open();
      } else if (c == '}' || c == ';' || EndsLabel(c)) {
        head_.clear();
      } else {
        if (head_.empty() && std::isspace(static_cast<unsigned char>(c)) == 0) head_line_ = line_;
        if (!head_.empty() || std::isspace(static_cast<unsigned char>(c)) == 0) head_ += c;
      }
    }
    return functions_;
  }

 private:
  bool EndsLabel(char c) const { return c == ':' && (head_ == "public" || head_ == "private" || head_ == "protected"); }

  void Open() {
    if (OpensScope(head_)) {
      head_.clear();
      return;
    }
    function_ = OpensFunction(head_);
    depth_ = 1;
  }

  void Inside(char c) {
    depth_ += c == '{' ? 1 : c == '}' ? -1 : 0;
    if (depth_ > 0) return;
    // A member initialiser in braces, and not yet the body, where a comma or another block follows.
    const size_t after = code_.find_first_not_of(" \n\t", next_ + 1);
    const bool goes_on = function_ && after != std::string::npos && (code_[after] == ',' || code_[after] == '{');
    if (goes_on) return;
    if (function_) functions_.push_back({head_line_, line_ - head_line_ + 1});
    head_.clear();
  }

  const std::string& code_;
  size_t next_ = 0;
  int line_ = 1;
  int depth_ = 0;
  bool function_ = false;
  int head_line_ = 1;
  std::string head_;
  std::vector<Function> functions_;
};

}  // namespace

std::vector<Function> FunctionsOf(std::string_view text) {
  const std::string code = CodeOf(text);
  return Reader(code).Read();
}

Faults FunctionFaults(std::string_view path, std::string_view text) {
  Faults faults;
  for (const Function& function : FunctionsOf(text)) {
    if (function.lines <= kLongestFunction) continue;
    faults.push_back(std::string(path) + ":" + std::to_string(function.line) + ": a function of " +
                     std::to_string(function.lines) + " lines; split it, " + std::to_string(kLongestFunction) +
                     " is the most");
  }
  return faults;
}

}  // namespace phrenic::architecture
