// A bar on standard error for work of more than a second; nothing where that is no terminal.
#ifndef PHRENIC_CLIENT_TERMINAL_PROGRESS_H_
#define PHRENIC_CLIENT_TERMINAL_PROGRESS_H_

#include <chrono>
#include <string>
#include <thread>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"

namespace phrenic::client {

// Any thread may call. A thread of its own draws, from the first second on, ten times a second: the share that is done
// and the time that is left, or, where the total is not known, the time since it began. The bar goes when the object
// does.
class Progress {
 public:
  // `total` 0: not known.
  explicit Progress(std::string what, double total = 0);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // What is being done now, behind the bar.
  void Say(std::string doing);
  void Update(double done);

 private:
  using Clock = std::chrono::steady_clock;
  void Draw();
  std::string Line() const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  const std::string what_;
  const double total_;
  const Clock::time_point start_ = Clock::now();
  absl::Mutex mutex_;
  std::string doing_ ABSL_GUARDED_BY(mutex_);
  double done_ ABSL_GUARDED_BY(mutex_) = 0;
  bool over_ ABSL_GUARDED_BY(mutex_) = false;
  std::thread drawing_;
};

// Does what cannot say how far it is, behind its name and the time since it began.
template <typename Work>
auto WithProgress(std::string what, Work work) {
  const Progress progress(std::move(what));
  return work();
}

// "12 s", "3 min", "2 h 05 min".
std::string DurationText(double seconds);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_TERMINAL_PROGRESS_H_
