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

constexpr absl::Duration kPatience = absl::Seconds(1), kBetween = absl::Milliseconds(100);
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

void Progress::Say(std::string doing) {
  const absl::MutexLock lock(&mutex_);
  doing_ = std::move(doing);
}

void Progress::Update(double done) {
  const absl::MutexLock lock(&mutex_);
  done_ = done;
}

void Progress::Draw() {
  const absl::MutexLock lock(&mutex_);
  if (mutex_.AwaitWithTimeout(absl::Condition(&over_), kPatience)) return;
  do {
    std::cerr << "\r" << Clipped(Line(), WidthOf(STDERR_FILENO) - 1) << "\x1b[K" << std::flush;
  } while (!mutex_.AwaitWithTimeout(absl::Condition(&over_), kBetween));
  std::cerr << "\r\x1b[K" << std::flush;
}

std::string Progress::Line() const {
  const std::chrono::duration<double> spent = Clock::now() - start_;
  const double share = total_ > 0 ? std::clamp(done_ / total_, 0.0, 1.0) : 0;
  const std::string doing = doing_.empty() ? "" : "  " + doing_;
  if (share == 0) return absl::StrFormat("%s ... %s%s", what_, DurationText(std::floor(spent.count())), doing);
  const int filled = static_cast<int>(share * kBarWidth);
  const std::string bar = std::string(filled, '#') + std::string(kBarWidth - filled, '.');
  const double left = spent.count() * (1 - share) / share;
  return absl::StrFormat("%s [%s] %3.0f %%, %s left%s", what_, bar, 100 * share, DurationText(left), doing);
}

}  // namespace phrenic::client
