// A call that a service of this server answers.
#ifndef PHRENIC_SERVER_SERVICE_CALLS_SERVED_CALL_H_
#define PHRENIC_SERVER_SERVICE_CALLS_SERVED_CALL_H_

#include <grpcpp/support/byte_buffer.h>

#include <functional>
#include <memory>
#include <optional>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"
#include "server/service/calls/incoming_call.h"

namespace phrenic::service {

class ServedCall;

// A method of a service. Plain data.
struct Method {
  // Handles one request on a thread of the lane, and returns how the call ends. nullopt: it goes on without a thread
  // (ServedCall::Continue), or with the next request (`conversation`).
  using Handler = std::function<std::optional<grpc::Status>(ServedCall& call)>;

  const access::Rule* rule = nullptr;
  Lane lane = Lane::kQuick;
  Handler handler;
  bool conversation = false;  // takes any number of requests
};

// What a stream does that needs no thread. gRPC's threads call it. See grpc::ServerWriteReactor.
class StreamEvents {
 public:
  virtual ~StreamEvents() = default;
  virtual void OnWriteDone(bool ok) = 0;
  virtual void OnCancel() = 0;
  virtual void OnDone() = 0;
};

// gRPC's threads and one thread of the lane call it.
class ServedCall final : public IncomingCall {
 public:
  // `method` and the references outlive the call; null: there is no such method.
  static ServedCall* Make(const Method* method, AccessGuard& guard, CallLimits& limits,
                          grpc::GenericCallbackServerContext& context);

  using IncomingCall::FinishOnce;
  using IncomingCall::request;

  // For handlers. Writes a message and waits until the client's flow control accepts it. False if the client is gone,
  // or has not read for a minute.
  bool Write(const grpc::ByteBuffer& message) ABSL_LOCKS_EXCLUDED(mutex_);
  // Sends the only message, and ends the call. RESOURCE_EXHAUSTED, which ends it too, if the message is large and the
  // client leaves too many of them unread.
  void Reply(const grpc::ByteBuffer& message);
  // From now on `events` starts the writes, and calls Finish; a handler that returns nullopt calls it last.
  void Continue(std::shared_ptr<StreamEvents> events) ABSL_LOCKS_EXCLUDED(mutex_);

  void OnWriteDone(bool ok) override ABSL_LOCKS_EXCLUDED(mutex_);
  void OnCancel() override ABSL_LOCKS_EXCLUDED(mutex_);
  void OnDone() override ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  ServedCall(const Method* method, AccessGuard& guard, CallLimits& limits, grpc::GenericCallbackServerContext& context)
      : IncomingCall(guard, limits, context), method_(method) {}
  void OnRequest() override;
  void OnNoRequest() override;
  void Run();
  std::shared_ptr<StreamEvents> events() ABSL_LOCKS_EXCLUDED(mutex_);

  const Method* const method_;
  grpc::ByteBuffer outgoing_;
  FairShare::Hold reply_;
  bool answered_ = false;  // a conversation had a request

  absl::Mutex mutex_;
  bool writing_ ABSL_GUARDED_BY(mutex_) = false;
  bool written_ ABSL_GUARDED_BY(mutex_) = false;  // the last write was accepted
  std::shared_ptr<StreamEvents> events_ ABSL_GUARDED_BY(mutex_);
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_CALLS_SERVED_CALL_H_
