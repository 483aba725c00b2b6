// Ctrl-C: cancels the call that is under way, so that a command ends cleanly and a half-written file is removed.
#ifndef PHRENIC_CLIENT_TERMINAL_INTERRUPTION_H_
#define PHRENIC_CLIENT_TERMINAL_INTERRUPTION_H_

#include <grpcpp/client_context.h>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"

namespace phrenic::client {

// One a process, made before any other thread. Its thread waits for SIGINT and SIGTERM and ends with the process.
class Interruption {
 public:
  Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  bool happened() const;

  // The call that an interruption cancels while this lives; one that happened before cancels at once.
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
  void Wait();

  mutable absl::Mutex mutex_;
  bool happened_ ABSL_GUARDED_BY(mutex_) = false;
  grpc::ClientContext* call_ ABSL_GUARDED_BY(mutex_) = nullptr;
};

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_TERMINAL_INTERRUPTION_H_
