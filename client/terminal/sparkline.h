// Numbers drawn as text.
#ifndef PHRENIC_CLIENT_TERMINAL_SPARKLINE_H_
#define PHRENIC_CLIENT_TERMINAL_SPARKLINE_H_

#include <span>
#include <string>

namespace phrenic::client {

// Returns one character per value: eighths of a block, or "_.-=*#" if not `unicode`. Values are clamped to
// [low, high]. The middle character if low == high or a value is not finite. Blocks are UTF-8, three bytes each.
// Thread-safe, as Bar.
std::string Sparkline(std::span<const double> values, double low, double high, bool unicode);

// Returns a bar of `width` characters, filled to (value - low) / (high - low). Empty if low == high or the value is not
// finite. Filled in eighths of a character, or in "#" and "." if not `unicode`.
std::string Bar(double value, double low, double high, int width, bool unicode);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_TERMINAL_SPARKLINE_H_
