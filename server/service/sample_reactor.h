// The server side of one WatchSamples stream: writes the newest samples some times a second, one message at a time.
#ifndef PHRENIC_SERVER_SERVICE_SAMPLE_REACTOR_H_
#define PHRENIC_SERVER_SERVICE_SAMPLE_REACTOR_H_

#include <grpcpp/alarm.h>
#include <grpcpp/support/byte_buffer.h>

#include <functional>
#include <memory>
#include <optional>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"
#include "server/service/calls/served_call.h"
#include "server/service/sample_reader.h"

namespace phrenic::service {

// Thread-safe: gRPC's threads call it. The call keeps it alive until OnDone, an alarm a little longer. At most one
// write is in progress, and a slow client misses samples, so it costs no memory and delays no other. The stream ends
// with CANCELLED, with PERMISSION_DENIED, or with the reason for which the session ended.
class SampleReactor final : public StreamEvents, public std::enable_shared_from_this<SampleReactor> {
 public:
  // What SampleService attaches to a stream; released when it ends. may_see runs under the reactor's lock.
  struct Subscription {
    std::shared_ptr<void> seats;    // given back when it is destroyed
    std::function<bool()> may_see;  // checked before each message; null: always allowed
  };

  // How long sampling goes on after a stream, so that one that was lost can be resumed.
  static constexpr absl::Duration kKept = absl::Seconds(15);

  // The call outlives the stream. Make it in a shared pointer.
  SampleReactor(ServedCall& call, SampleReader reader, Subscription subscription)
      : call_(call), reader_(std::move(reader)), subscription_(std::move(subscription)) {}

  // Starts the stream. Call it once.
  void Start();

  // Reactions, on gRPC's threads. OnDone releases the session.
  void OnWriteDone(bool ok) override ABSL_LOCKS_EXCLUDED(mutex_);
  void OnCancel() override ABSL_LOCKS_EXCLUDED(mutex_);
  void OnDone() override ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  // The next operation: a write, a finish, a wait, or none.
  struct Next {
    bool write = false, wait = false;
    std::optional<grpc::Status> finish = std::nullopt;
  };

  // Decides what to do and marks it as begun, so that only the calling thread does it.
  Next TakeNext() ABSL_LOCKS_EXCLUDED(mutex_);
  Next TakeBatch() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  // Does the next operation. Does not block.
  void Pump() ABSL_LOCKS_EXCLUDED(mutex_);
  // Calls Pump after the time between two messages.
  void Wait() ABSL_LOCKS_EXCLUDED(mutex_);

  ServedCall& call_;                                            // until it is finished
  absl::Mutex mutex_;                                           // not held while gRPC is called
  std::optional<SampleReader> reader_ ABSL_GUARDED_BY(mutex_);  // until OnDone
  Subscription subscription_ ABSL_GUARDED_BY(mutex_);           // until OnDone
  std::unique_ptr<grpc::Alarm> alarm_ ABSL_GUARDED_BY(mutex_);  // of the wait
  bool busy_ ABSL_GUARDED_BY(mutex_) = false;                   // a write or a wait is in progress
  bool first_ ABSL_GUARDED_BY(mutex_) = true;                   // no message was written
  bool more_ ABSL_GUARDED_BY(mutex_) = false;                   // samples wait already
  bool cancelled_ ABSL_GUARDED_BY(mutex_) = false;              // by the client, or a write has failed
  bool finished_ ABSL_GUARDED_BY(mutex_) = false;
  grpc::ByteBuffer buffer_;  // owned by the thread that set busy_, until the write is done
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_SAMPLE_REACTOR_H_
