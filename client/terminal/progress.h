// A progress bar on standard error.
#ifndef PHRENIC_CLIENT_TERMINAL_PROGRESS_H_
#define PHRENIC_CLIENT_TERMINAL_PROGRESS_H_

#include <chrono>
#include <string>
#include <thread>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"

namespace phrenic::client {

// Draws a progress bar from its own thread, ten times a second, starting one second after construction: the fraction
// done and the remaining time, or the elapsed time if the total is unknown. The destructor erases the bar. Draws
// nothing if standard error is not a terminal. Thread-safe.
class Progress {
 public:
  // `total`: the value of Update at the end, in any unit; 0 if it is unknown.
  explicit Progress(std::string what, double total = 0);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // Sets the text after the bar, such as the current stage.
  void SetDetail(std::string detail);
  // Sets how much of the total is done.
  void Update(double done);

 private:
  using Clock = std::chrono::steady_clock;
  void Draw();
  std::string Line() const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  const std::string what_;
  const double total_;
  const Clock::time_point start_ = Clock::now();
  absl::Mutex mutex_;
  std::string detail_ ABSL_GUARDED_BY(mutex_);
  double done_ ABSL_GUARDED_BY(mutex_) = 0;
  bool over_ ABSL_GUARDED_BY(mutex_) = false;
  std::thread drawing_;
};

// Runs `work` and shows its elapsed time. Returns what `work` returns.
template <typename Work>
auto WithProgress(std::string what, Work work) {
  const Progress progress(std::move(what));
  return work();
}

// Formats a duration [s], rounded up: "12 s", "3 min", "2 h 05 min".
std::string DurationText(double seconds);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_TERMINAL_PROGRESS_H_
