#include "client/terminal/sparkline.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace phrenic::client {
namespace {

constexpr std::array<const char*, 8> kBlocks = {"▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};
constexpr std::array<const char*, 6> kPlain = {"_", ".", "-", "=", "*", "#"};
constexpr std::array<const char*, 8> kEighths = {"", "▏", "▎", "▍", "▌", "▋", "▊", "▉"};

double FractionOf(double value, double low, double high, double fallback) {
  return high > low && std::isfinite(value) ? std::clamp((value - low) / (high - low), 0.0, 1.0) : fallback;
}

}  // namespace

std::string Sparkline(std::span<const double> values, double low, double high, bool unicode) {
  const std::span<const char* const> levels = unicode ? std::span<const char* const>(kBlocks) : kPlain;
  std::string line;
  for (const double value : values) {
    const double fraction = FractionOf(value, low, high, 0.5);
    line += levels[std::min(levels.size() - 1, static_cast<size_t>(fraction * static_cast<double>(levels.size())))];
  }
  return line;
}

std::string Bar(double value, double low, double high, int width, bool unicode) {
  constexpr int kParts = 8;
  const int parts = static_cast<int>(std::lround(FractionOf(value, low, high, 0) * width * kParts));
  std::string bar;
  for (int i = 0; i < width; ++i) {
    const int filled = std::clamp(parts - kParts * i, 0, kParts);
    if (!unicode) {
      bar += filled >= kParts / 2 ? "#" : ".";
    } else {
      bar += filled == kParts ? "█" : filled == 0 ? " " : kEighths[static_cast<size_t>(filled)];
    }
  }
  return bar;
}

}  // namespace phrenic::client
