// Whether a long computation has to end early: nobody waits for its result, or it has taken too long.
#ifndef PHRENIC_SERVER_MECHANICS_STOP_CHECK_H_
#define PHRENIC_SERVER_MECHANICS_STOP_CHECK_H_

#include <chrono>
#include <functional>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"

namespace phrenic {

// Loops over vertices call Stopped() and leave; the stage that contains them then returns status(). Once stopped, it
// stays stopped. Not thread-safe: it belongs to the thread that computes.
class StopCheck {
 public:
  // Never stops.
  StopCheck() = default;
  // Stops when `cancelled` returns true, which is asked 50 times a second at most, or after `longest` [s]; 0: no limit.
  // `setting` names the limit in the error.
  StopCheck(std::function<bool()> cancelled, double longest, const char* setting)
      : cancelled_(std::move(cancelled)), longest_(longest), setting_(setting) {}

  // About 30 ns.
  bool Stopped() const {
    if (!status_.ok()) return true;
    if (cancelled_ == nullptr && longest_ <= 0) return false;
    const auto now = Clock::now();
    if (now < next_) return false;
    next_ = now + std::chrono::milliseconds(20);
    if (longest_ > 0 && now - started_ > std::chrono::duration<double>(longest_)) {
      status_ = absl::ResourceExhaustedError(
          absl::StrCat("the scene takes more than ", longest_, " s to compile (", setting_, "); make it smaller"));
    } else if (cancelled_ != nullptr && cancelled_()) {
      status_ = absl::CancelledError("nobody waits for the scene any more");
    }
    return !status_.ok();
  }
  // OK, CANCELLED, or RESOURCE_EXHAUSTED after too long a time.
  absl::Status status() const { return Stopped() ? status_ : absl::OkStatus(); }

 private:
  using Clock = std::chrono::steady_clock;

  std::function<bool()> cancelled_;
  double longest_ = 0;  // [s]
  const char* setting_ = "";
  Clock::time_point started_ = Clock::now();
  mutable Clock::time_point next_{};
  mutable absl::Status status_;
};

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MECHANICS_STOP_CHECK_H_
