// Numbers drawn in a line of text.
#ifndef PHRENIC_CLIENT_TERMINAL_SPARKLINE_H_
#define PHRENIC_CLIENT_TERMINAL_SPARKLINE_H_

#include <span>
#include <string>

namespace phrenic::client {

// One character a value, the lowest at `low` and the highest at `high`, which are clipped to: eighths of a block, or
// "_.-=*#" where there is no Unicode. A line in the middle where `low` is `high`.
std::string Sparkline(std::span<const double> values, double low, double high, bool unicode);

// A bar `width` characters long, as full as `value` lies between `low` and `high`; empty where these are equal.
std::string Bar(double value, double low, double high, int width, bool unicode);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_TERMINAL_SPARKLINE_H_
