// Ctrl-C: cancels the call in progress, so that a command ends cleanly and removes half-written files.
#ifndef PHRENIC_CLIENT_TERMINAL_INTERRUPTION_H_
#define PHRENIC_CLIENT_TERMINAL_INTERRUPTION_H_

#include <grpcpp/client_context.h>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"

namespace phrenic::client {

// Handles SIGINT and SIGTERM on its own thread, until the process ends. The first signal cancels the call in progress;
// the second ends the process with exit code 130. Thread-safe. Requires: one per process, constructed before any other
// thread starts. main constructs it first and passes it to the commands by Context::interruption. Its thread is never
// joined, so it must live until the process ends.
class Interruption {
 public:
  // Blocks both signals in the calling thread; threads that start later inherit that.
  Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  // True once a signal was received.
  bool happened() const;

  // Registers the call that a signal cancels, for the scope's lifetime. Cancels the call at once if a signal was
  // received before. At most one scope exists at a time. The interruption and the context outlive it.
  class Scope {
   public:
    Scope(Interruption& interruption, grpc::ClientContext& context);
    ~Scope();
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    Interruption& interruption_;
  };

 private:
  // The thread's function: waits for signals.
  void Wait();

  mutable absl::Mutex mutex_;
  bool happened_ ABSL_GUARDED_BY(mutex_) = false;                // a signal was received
  grpc::ClientContext* call_ ABSL_GUARDED_BY(mutex_) = nullptr;  // null: no call is in progress
};

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_TERMINAL_INTERRUPTION_H_
