// A bar on standard error for work of more than a moment; nothing where that is not a terminal.
#ifndef PHRENIC_CLIENT_PROGRESS_H_
#define PHRENIC_CLIENT_PROGRESS_H_

#include <chrono>
#include <string>

namespace phrenic::client {

// Not thread-safe. The bar goes when the object does.
class Progress {
 public:
  Progress(std::string what, double total);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // What is being done now, behind the bar.
  void Say(std::string doing) { doing_ = std::move(doing); }
  // Draws at most ten times a second, with the time left.
  void Update(double done);

 private:
  using Clock = std::chrono::steady_clock;
  std::string what_, doing_;
  double total_;
  bool terminal_;
  Clock::time_point start_ = Clock::now(), drawn_ = start_;
};

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_PROGRESS_H_
