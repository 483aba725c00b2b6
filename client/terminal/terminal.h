// The terminal's capabilities, and text fitted to its width. A stream is STDOUT_FILENO or STDERR_FILENO.
#ifndef PHRENIC_CLIENT_TERMINAL_TERMINAL_H_
#define PHRENIC_CLIENT_TERMINAL_TERMINAL_H_

#include <string>
#include <string_view>

namespace phrenic::client {

// True if the stream is a terminal that understands cursor movements. False if TERM is "dumb". Progress and live views
// are drawn only then.
bool IsTerminal(int stream);
// Returns the number of columns, at least 20; 80 if the stream is not a terminal. Asks the terminal each time, since
// its size may change.
int WidthOf(int stream);
// Returns the number of lines; 24 if the stream is not a terminal.
int HeightOf(int stream);
// True if the stream is a terminal and NO_COLOR is not set (no-color.org). False also if TERM is "dumb".
bool HasColour(int stream);
// True if the locale uses UTF-8. Reads LC_ALL, LC_CTYPE and LANG; the first that is set decides.
bool ShowsUnicode();

// Colours of the terminal's own palette.
enum class Ink { kBold, kDim, kRed, kGreen, kYellow, kCyan };
// Returns the text with the escape codes of `ink`; unchanged if the stream has no colours.
std::string Painted(const std::string& text, Ink ink, int stream);

// Returns the number of characters of UTF-8 text. Each character counts as one column. Escape codes count as well:
// measure text before Painted.
int ColumnsOf(std::string_view text);
// Returns the first `columns` characters. Never cuts a character apart.
std::string Clipped(const std::string& text, int columns);
// Breaks text between words into lines of at most `width` columns. Every line after the first starts with `indent`
// spaces, which count towards the width. A word longer than a line stays whole. Runs of blanks become one; the text
// ends without a line break.
std::string Wrapped(const std::string& text, int width, int indent);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_TERMINAL_TERMINAL_H_
