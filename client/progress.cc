#include "client/progress.h"

#include <unistd.h>

#include <algorithm>
#include <iostream>

#include "absl/strings/str_format.h"

namespace phrenic::client {

Progress::Progress(std::string what, double total)
    : what_(std::move(what)), total_(total), terminal_(isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() {
  if (terminal_ && drawn_ != start_) std::cerr << "\r\x1b[K" << std::flush;
}

void Progress::Update(double done) {
  constexpr int kWidth = 30;
  const auto now = Clock::now();
  if (!terminal_ || now - drawn_ < std::chrono::milliseconds(100)) return;
  drawn_ = now;
  const double share = total_ > 0 ? std::clamp(done / total_, 0.0, 1.0) : 0;
  const std::chrono::duration<double> spent = now - start_;
  const int filled = static_cast<int>(share * kWidth);
  const std::string bar = std::string(filled, '#') + std::string(kWidth - filled, '.');
  const double left = share > 0 ? spent.count() * (1 - share) / share : 0;
  std::cerr << absl::StrFormat("\r%s [%s] %3.0f %%, %.0f s left  %s\x1b[K", what_, bar, 100 * share, left, doing_)
            << std::flush;
}

}  // namespace phrenic::client
