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
// nothing if standard error is not a terminal. Thread-safe. Commands create one for the time of a long call. Standard
// output stays free for results.
class Progress {
 public:
  // `total`: the value of Update at the end, in any unit; 0 if it is unknown. `what` stands before the bar, such as
  // "compiling thorax".
  explicit Progress(std::string what, double total = 0);
  // Waits for the thread.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // Sets the text after the bar, such as the current stage.
  void SetDetail(std::string detail);
  // Sets how much of the total is done. In the unit of `total`; beyond it, the bar is full.
  void Update(double done);

 private:
  using Clock = std::chrono::steady_clock;
  // The thread's function: draws until the destructor ends it.
  void Draw();
  // Returns the bar as text, wider than the terminal perhaps. The time left assumes that the rest takes as long as what
  // is done.
  std::string Line() const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  const std::string what_;  // before the bar
  const double total_;      // 0: unknown
  const Clock::time_point start_ = Clock::now();
  absl::Mutex mutex_;
  std::string detail_ ABSL_GUARDED_BY(mutex_);  // after the bar
  double done_ ABSL_GUARDED_BY(mutex_) = 0;     // in the unit of total_
  bool over_ ABSL_GUARDED_BY(mutex_) = false;   // true: the thread ends
  std::thread drawing_;                         // not started unless standard error is a terminal
};

// Runs `work` and shows its elapsed time. Returns what `work` returns. `work` runs on the calling thread.
template <typename Work>
auto WithProgress(std::string what, Work work) {
  const Progress progress(std::move(what));
  return work();
}

// Formats a duration [s], rounded up: "12 s", "3 min", "2 h 05 min". From two minutes on, it is rounded to the nearest
// minute.
std::string DurationText(double seconds);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_TERMINAL_PROGRESS_H_
