#include "client/terminal/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "absl/strings/str_format.h"
#include "absl/time/time.h"
#include "client/terminal/terminal.h"

namespace phrenic::client {
namespace {

constexpr absl::Duration kDelay = absl::Seconds(1), kPeriod = absl::Milliseconds(100);
constexpr int kBarWidth = 30;

}  // namespace

std::string DurationText(double seconds) {
  const auto whole = static_cast<std::int64_t>(std::ceil(seconds));
  if (whole < 120) return absl::StrFormat("%d s", whole);
  const std::int64_t minutes = (whole + 30) / 60;
  return minutes < 60 ? absl::StrFormat("%d min", minutes)
                      : absl::StrFormat("%d h %02d min", minutes / 60, minutes % 60);
}

Progress::Progress(std::string what, double total) : what_(std::move(what)), total_(total) {
  if (IsTerminal(STDERR_FILENO)) drawing_ = std::thread([this] { Draw(); });
}

Progress::~Progress() {
  {
    const absl::MutexLock lock(&mutex_);
    over_ = true;
  }
  if (drawing_.joinable()) drawing_.join();
}

void Progress::SetDetail(std::string detail) {
  const absl::MutexLock lock(&mutex_);
  detail_ = std::move(detail);
}

void Progress::Update(double done) {
  const absl::MutexLock lock(&mutex_);
  done_ = done;
}

void Progress::Draw() {
  const absl::MutexLock lock(&mutex_);
  if (mutex_.AwaitWithTimeout(absl::Condition(&over_), kDelay)) return;
  do {
    std::cerr << "\r" << Clipped(Line(), WidthOf(STDERR_FILENO) - 1) << "\x1b[K" << std::flush;
  } while (!mutex_.AwaitWithTimeout(absl::Condition(&over_), kPeriod));
  std::cerr << "\r\x1b[K" << std::flush;
}

std::string Progress::Line() const {
  const std::chrono::duration<double> elapsed = Clock::now() - start_;
  const double fraction = total_ > 0 ? std::clamp(done_ / total_, 0.0, 1.0) : 0;
  const std::string detail = detail_.empty() ? "" : "  " + detail_;
  if (fraction == 0) return absl::StrFormat("%s ... %s%s", what_, DurationText(std::floor(elapsed.count())), detail);
  const int filled = static_cast<int>(fraction * kBarWidth);
  const std::string bar = std::string(filled, '#') + std::string(kBarWidth - filled, '.');
  const double left = elapsed.count() * (1 - fraction) / fraction;
  return absl::StrFormat("%s [%s] %3.0f %%, %s left%s", what_, bar, 100 * fraction, DurationText(left), detail);
}

}  // namespace phrenic::client
