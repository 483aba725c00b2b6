#include "server/meshio/frame.h"

#include <algorithm>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "server/meshio/text.h"

namespace phrenic::meshio {
namespace {

constexpr std::string_view kSpace = "space";
constexpr std::string_view kFrameBlanks = " \t\r\n\v\f\"'";
constexpr const char* kRemedy = "state SPACE=LPS or SPACE=RAS there, or nothing for LPS";

bool IsPartOfName(char c) {
  return absl::ascii_isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '+' || c == '_';
}

Frame FrameNamed(std::string_view name) {
  static constexpr std::pair<std::string_view, Frame> kNames[] = {
      {"lps", Frame::kLps}, {"lps+", Frame::kLps}, {"left-posterior-superior", Frame::kLps},
      {"ras", Frame::kRas}, {"ras+", Frame::kRas}, {"right-anterior-superior", Frame::kRas}};
  const std::string lower = absl::AsciiStrToLower(std::string(name));
  for (const auto& [known, frame] : kNames) {
    if (known == lower) return frame;
  }
  return Frame::kUnspecified;
}

std::string Set(std::string_view name, Frame& frame) {
  const Frame named = FrameNamed(name);
  if (named == Frame::kUnspecified) {
    return absl::StrCat("the frame ", Quoted(name), " of SPACE is not supported; ", kRemedy);
  }
  if (frame != Frame::kUnspecified && frame != named) {
    return absl::StrCat("the file states both frames, LPS and RAS; ", kRemedy);
  }
  frame = named;
  return "";
}

void SkipBlanks(std::string_view& text) {
  text.remove_prefix(std::min(text.find_first_not_of(kFrameBlanks), text.size()));
}

// Removes the name at the start of `text` and returns it.
std::string_view TakeName(std::string_view& text) {
  const auto end = std::find_if_not(text.begin(), text.end(), IsPartOfName);
  const std::string_view name = text.substr(0, static_cast<std::size_t>(end - text.begin()));
  text.remove_prefix(name.size());
  return name;
}

// Reads what follows the word SPACE. Removes it from `text`.
std::string ReadStatement(std::string_view& text, Frame& frame) {
  SkipBlanks(text);
  const bool sign = !text.empty() && (text[0] == '=' || text[0] == ':');
  if (sign) text.remove_prefix(1);
  SkipBlanks(text);
  std::string_view after = text;
  const std::string_view name = TakeName(after);
  if (!sign && FrameNamed(name) == Frame::kUnspecified) return "";
  text = after;
  return Set(name, frame);
}

}  // namespace

std::string ReadFrame(std::string_view text, Frame& frame) {
  for (std::size_t at = 0; at + kSpace.size() <= text.size(); ++at) {
    const bool starts =
        at == 0 || !(absl::ascii_isalnum(static_cast<unsigned char>(text[at - 1])) || text[at - 1] == '_');
    if (!starts || !absl::EqualsIgnoreCase(absl::string_view(text.data() + at, kSpace.size()), "space")) continue;
    std::string_view rest = text.substr(at + kSpace.size());
    if (!rest.empty() && IsPartOfName(rest[0])) continue;
    if (std::string fault = ReadStatement(rest, frame); !fault.empty()) return fault;
    at = text.size() - rest.size() - 1;
  }
  return "";
}

std::string ReadFrameField(std::string_view value, Frame& frame) {
  const std::string_view whole = value;
  SkipBlanks(value);
  const std::string_view name = TakeName(value);
  SkipBlanks(value);
  if (value.empty()) return Set(name, frame);
  const Frame before = std::exchange(frame, Frame::kUnspecified);
  if (std::string fault = ReadFrame(whole, frame); !fault.empty()) return fault;
  const Frame stated = std::exchange(frame, before);
  if (stated == Frame::kUnspecified) return Set(whole, frame);
  return Set(stated == Frame::kRas ? "RAS" : "LPS", frame);
}

bool IsFrameField(std::string_view name) {
  return absl::EqualsIgnoreCase(absl::string_view(name.data(), name.size()), "space");
}

}  // namespace phrenic::meshio
