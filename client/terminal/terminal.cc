#include "client/terminal/terminal.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "client/terminal/environment.h"

namespace phrenic::client {
namespace {

constexpr int kDefaultWidth = 80, kLeastWidth = 20, kDefaultHeight = 24;

const char* CodeOf(Ink ink) {
  switch (ink) {
    case Ink::kBold:
      return "1";
    case Ink::kDim:
      return "2";
    case Ink::kRed:
      return "31";
    case Ink::kGreen:
      return "32";
    case Ink::kYellow:
      return "33";
    case Ink::kCyan:
      return "36";
  }
  return "0";
}

// Returns zeros if the stream is not a terminal.
winsize SizeOf(int stream) {
  winsize size = {};
  if (isatty(stream) == 0 || ioctl(stream, TIOCGWINSZ, &size) != 0) return {};
  return size;
}

bool StartsCharacter(char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }

}  // namespace

bool IsTerminal(int stream) { return isatty(stream) != 0 && EnvironmentVariable("TERM") != "dumb"; }

int WidthOf(int stream) {
  const winsize size = SizeOf(stream);
  return size.ws_col == 0 ? kDefaultWidth : std::max<int>(kLeastWidth, size.ws_col);
}

int HeightOf(int stream) {
  const winsize size = SizeOf(stream);
  return size.ws_row == 0 ? kDefaultHeight : size.ws_row;
}

bool HasColour(int stream) { return IsTerminal(stream) && EnvironmentVariable("NO_COLOR").empty(); }

bool ShowsUnicode() {
  for (const char* name : {"LC_ALL", "LC_CTYPE", "LANG"}) {
    if (const std::string value = absl::AsciiStrToUpper(EnvironmentVariable(name)); !value.empty()) {
      return absl::StrContains(value, "UTF-8") || absl::StrContains(value, "UTF8");
    }
  }
  return false;
}

std::string Painted(const std::string& text, Ink ink, int stream) {
  return HasColour(stream) ? absl::StrCat("\x1b[", CodeOf(ink), "m", text, "\x1b[0m") : text;
}

int ColumnsOf(std::string_view text) { return static_cast<int>(std::ranges::count_if(text, StartsCharacter)); }

std::string Clipped(const std::string& text, int columns) {
  std::size_t end = 0;
  for (int characters = 0; end < text.size(); ++end) {
    if (StartsCharacter(text[end]) && characters++ == columns) break;
  }
  return text.substr(0, end);
}

std::string Wrapped(const std::string& text, int width, int indent) {
  std::string wrapped;
  int column = 0;
  for (const absl::string_view word : absl::StrSplit(text, ' ', absl::SkipEmpty())) {
    const int length = ColumnsOf({word.data(), word.size()});
    if (column > 0 && indent + column + 1 + length > width) {
      wrapped += "\n" + std::string(indent, ' ');
      column = 0;
    }
    absl::StrAppend(&wrapped, column > 0 ? " " : "", word);
    column += length + (column > 0 ? 1 : 0);
  }
  return wrapped;
}

}  // namespace phrenic::client
