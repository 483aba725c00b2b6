// A client that steps one session and compares every response with an undisturbed run in this process.
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

inline constexpr std::int64_t kTicksPerStep = 7;

// The undisturbed run. Thread-safe.
class Oracle {
 public:
  Oracle();
  // Returns the state's hash after `tick` ticks, a multiple of kTicksPerStep.
  std::string HashAt(std::int64_t tick);

 private:
  absl::Mutex mutex_;
  std::unique_ptr<service::Server> server_;
  std::unique_ptr<v1::SessionService::Stub> stub_;
  std::map<std::int64_t, std::string> hashes_ ABSL_GUARDED_BY(mutex_);
};

// Not thread-safe.
class Driver {
 public:
  explicit Driver(Oracle& oracle, std::string session = "driven") : oracle_(oracle), session_(std::move(session)) {}
  // Connects to a server and creates the session if `create` is true. False if that fails; error() says why.
  bool Connect(const std::string& address, bool create = false);
  bool Connect(const std::shared_ptr<grpc::Channel>& channel, bool create);
  // Returns the session's tick. Retries for `seconds`; nullopt if the server has no such session or does not answer.
  std::optional<std::int64_t> FindTick(double seconds);
  // Steps the session by kTicksPerStep. Some ticks also change a parameter to a value that depends on the tick only, so
  // that a repeat makes the same change. False without a response; a hash that differs from the undisturbed run is
  // counted.
  bool Step();
  int wrong() const { return wrong_; }
  // The session of the last response, and whether its tick is known to be current.
  const v1::Session& seen() const { return seen_; }
  bool knows() const { return tick_ >= 0; }
  const std::string& error() const { return error_; }

 private:
  Oracle& oracle_;
  const std::string session_;
  v1::Session seen_;
  std::unique_ptr<v1::SessionService::Stub> stub_;
  std::int64_t tick_ = -1;  // -1: unknown
  int wrong_ = 0;
  std::string error_;
};

}  // namespace phrenic::faults

#endif  // PHRENIC_TESTS_FAULTS_DRIVER_H_
