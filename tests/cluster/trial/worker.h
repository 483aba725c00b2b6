// Clients of a cluster: each steps a session or watches a playing one, and retries after errors.
#ifndef PHRENIC_TESTS_CLUSTER_TRIAL_WORKER_H_
#define PHRENIC_TESTS_CLUSTER_TRIAL_WORKER_H_

#include <grpcpp/client_context.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"
#include "absl/time/clock.h"
#include "absl/time/time.h"
#include "tests/cluster/trial/deployment.h"
#include "tests/faults/driver.h"

namespace phrenic::cluster {

// An interval without messages from a session.
struct Gap {
  absl::Time begin, end;
  bool moved = false;      // another server had the session afterwards (a new epoch)
  double rolled_back = 0;  // simulated time that was received before the gap and lost [s]
};

// Thread-safe. Works on its own thread from construction to Stop.
class Worker {
 public:
  virtual ~Worker() = default;
  virtual void Stop() = 0;
  // Returns the gaps that ended after `since`, in order of time.
  std::vector<Gap> GapsSince(absl::Time since) const ABSL_LOCKS_EXCLUDED(mutex_);
  // Returns the time of the last message.
  absl::Time last() const ABSL_LOCKS_EXCLUDED(mutex_);

 protected:
  // Records a message with its epoch and simulated time [s].
  void Record(std::int64_t epoch, double time) ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  mutable absl::Mutex mutex_;
  absl::Time last_ ABSL_GUARDED_BY(mutex_) = absl::Now();
  std::int64_t epoch_ ABSL_GUARDED_BY(mutex_) = 0;
  double time_ ABSL_GUARDED_BY(mutex_) = 0;
  std::vector<Gap> gaps_ ABSL_GUARDED_BY(mutex_);
};

// Steps a session and compares every response with an undisturbed run (faults::Driver).
class Stepper final : public Worker {
 public:
  Stepper(const Deployment& deployment, faults::Oracle& oracle, const std::string& session);
  ~Stepper() override { Stop(); }
  void Stop() override;
  bool made() const { return made_; }
  // wrong, steps and Lost are valid after Stop.
  int wrong() const { return driver_.wrong(); }
  int steps() const { return steps_; }
  // True if the session no longer exists.
  bool Lost() { return !driver_.FindTick(20).has_value(); }
  const std::string& error() const { return driver_.error(); }

 private:
  void Work();
  faults::Driver driver_;
  bool made_ = false;
  int steps_ = 0;
  std::atomic<bool> stopped_ = false;
  std::thread thread_;
};

// Watches a session that plays at real time.
class Watcher final : public Worker {
 public:
  Watcher(const Deployment& deployment, std::string session);
  ~Watcher() override { Stop(); }
  void Stop() override;
  bool made() const { return made_; }
  // Pauses the session and compares its state with an undisturbed run of the same number of ticks. Sets `lost` if the
  // session no longer exists. Call it after Stop.
  bool Right(bool& lost);

 private:
  void Work();
  void WatchOnce();
  const std::string session_;
  const std::shared_ptr<grpc::Channel> channel_;
  bool made_ = false;
  std::atomic<bool> stopped_ = false;
  absl::Mutex call_mutex_;
  grpc::ClientContext* call_ ABSL_GUARDED_BY(call_mutex_) = nullptr;
  std::thread thread_;
};

}  // namespace phrenic::cluster

#endif  // PHRENIC_TESTS_CLUSTER_TRIAL_WORKER_H_
