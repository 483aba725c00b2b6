// What the terminal can show, and text made to fit it.
#ifndef PHRENIC_CLIENT_TERMINAL_TERMINAL_H_
#define PHRENIC_CLIENT_TERMINAL_TERMINAL_H_

#include <string>
#include <string_view>

namespace phrenic::client {

// The streams are named by their descriptors, STDOUT_FILENO or STDERR_FILENO.

// A terminal that can move its cursor: not where TERM is "dumb".
bool IsTerminal(int stream);
// Columns, 20 at least; 80 where it is no terminal.
int WidthOf(int stream);
// Lines; 24 where it is no terminal.
int HeightOf(int stream);
// A terminal, unless NO_COLOR is set to anything (no-color.org).
bool HasColour(int stream);
// Whether the locale is one of UTF-8.
bool ShowsUnicode();

enum class Ink { kBold, kDim, kRed, kGreen, kYellow, kCyan };
// The text in that ink where the stream has colours, and as it is elsewhere.
std::string Painted(const std::string& text, Ink ink, int stream);

// The characters of UTF-8 text, each counted as one column.
int PoseMatricesOf(std::string_view text);
// The first `columns` characters.
std::string Clipped(const std::string& text, int columns);
// Broken between words into lines of `width` columns, each after the first behind `indent` spaces, which count.
std::string Wrapped(const std::string& text, int width, int indent);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_TERMINAL_TERMINAL_H_
