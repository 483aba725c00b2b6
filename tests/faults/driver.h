// A client that steps one session and knows what every answer has to be: an undisturbed run in this process says so.
#ifndef PHRENIC_TESTS_FAULTS_DRIVER_H_
#define PHRENIC_TESTS_FAULTS_DRIVER_H_

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"
#include "phrenic/v1/session.grpc.pb.h"
#include "server/service/server.h"

namespace phrenic::faults {

inline constexpr std::int64_t kTicksAStep = 7;

// The undisturbed run. Any thread may call.
class Oracle {
 public:
  Oracle();
  // The hash after this many ticks, a multiple of kTicksAStep.
  std::string HashAt(std::int64_t tick);

 private:
  absl::Mutex mutex_;
  std::unique_ptr<service::Server> server_;
  std::unique_ptr<v1::SessionService::Stub> stub_;
  std::map<std::int64_t, std::string> hashes_ ABSL_GUARDED_BY(mutex_);
};

class Driver {
 public:
  explicit Driver(Oracle& oracle, std::string session = "driven") : oracle_(oracle), session_(std::move(session)) {}
  // Where the server is now; makes the session where `create` says so. False where it cannot be had.
  bool Connect(const std::string& address, bool create = false);
  bool Connect(const std::shared_ptr<grpc::Channel>& channel, bool create);
  // What the session's tick is, once the server answers; nothing where it does not have it, or not within `seconds`.
  std::optional<std::int64_t> FindTick(double seconds);
  // One call of kTicksAStep, with a change of a parameter now and then that is a function of the tick, so that whoever
  // repeats it makes the same one. Goes on where the session stands. False where there is no answer; a hash that is not
  // the undisturbed run's is counted.
  bool Step();
  int wrong() const { return wrong_; }
  // As it was answered last, and whether it still stands there as far as is known.
  const v1::Session& seen() const { return seen_; }
  bool knows() const { return tick_ >= 0; }
  const std::string& error() const { return error_; }

 private:
  Oracle& oracle_;
  const std::string session_;
  v1::Session seen_;
  std::unique_ptr<v1::SessionService::Stub> stub_;
  std::int64_t tick_ = -1;  // -1: not known
  int wrong_ = 0;
  std::string error_;
};

}  // namespace phrenic::faults

#endif  // PHRENIC_TESTS_FAULTS_DRIVER_H_
