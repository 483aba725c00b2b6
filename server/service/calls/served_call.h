// A call that a service of this server answers.
#ifndef PHRENIC_SERVER_SERVICE_CALLS_SERVED_CALL_H_
#define PHRENIC_SERVER_SERVICE_CALLS_SERVED_CALL_H_

#include <grpcpp/support/byte_buffer.h>

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"
#include "server/service/calls/incoming_call.h"

namespace phrenic::service {

class ServedCall;

// A method of a service. Plain data. CallTable owns the methods, which outlive their calls.
struct Method {
  // Handles one request on a thread of the lane, and returns how the call ends. nullopt: it goes on without a thread
  // (ServedCall::Continue), or with the next request (`conversation`). It may block there, reads
  // context().IsCancelled() to end early, and must not throw. Requires: a handler of a method that is no conversation
  // returns nullopt only after Continue, since nothing else would end the call.
  using Handler = std::function<std::optional<grpc::Status>(ServedCall& call)>;

  const access::Rule* rule = nullptr;  // of access/rules.cc, or a constant; gives the name
  Lane lane = Lane::kQuick;            // whose threads run the handler
  Handler handler;
  bool conversation = false;  // takes any number of requests
};

// What a stream does that needs no thread. gRPC's threads call it. See grpc::ServerWriteReactor.
//
// The call holds the events until it is destroyed. The methods must not block. OnDone comes last: the call must not be
// used afterwards.
class StreamEvents {
 public:
  virtual ~StreamEvents() = default;
  virtual void OnWriteDone(bool ok) = 0;
  virtual void OnCancel() = 0;
  virtual void OnDone() = 0;
};

// gRPC's threads and one thread of the lane call it.
//
// The request is read first, then the call waits for a place in the lane, then the handler runs on one of its threads
// with that place, and the call ends with the handler's status. The place is given back when the handler returns, also
// if the stream goes on.
class ServedCall final : public IncomingCall {
 public:
  // `method` and the references outlive the call; null: there is no such method. The call owns itself, and may be done
  // before Make returns: the pointer is for gRPC alone.
  static ServedCall* Make(const Method* method, AccessGuard& guard, CallLimits& limits,
                          grpc::GenericCallbackServerContext& context);

  using IncomingCall::FinishOnce;
  using IncomingCall::request;

  // For handlers. Writes a message and waits until the client's flow control accepts it. False if the client is gone,
  // has not read for a minute, or leaves too many large messages unread (Reserve). After that minute it cancels the
  // call. Requires: Continue was not called, and no other thread writes.
  bool Write(const grpc::ByteBuffer& message) ABSL_LOCKS_EXCLUDED(mutex_);
  // Takes the places in CallLimits::replies that a reply of so many bytes needs, so that a handler makes a large reply
  // only if it may be sent. RESOURCE_EXHAUSTED if the client leaves too many replies unread. The places are held until
  // OnDone; a further call, and Reply, take only those that are missing.
  absl::Status Reserve(std::size_t bytes);
  // Sends the only message, and ends the call. RESOURCE_EXHAUSTED, which ends it too, if the message is large and the
  // client leaves too many of them unread. Large means more than 64 KiB: its place in CallLimits::replies is held until
  // OnDone. The status that the handler returns afterwards has no effect.
  void Reply(const grpc::ByteBuffer& message);
  // From now on `events` starts the writes, and calls Finish; a handler that returns nullopt calls it last. If the
  // client has gone already, calls events->OnCancel before it returns. Events may come before it returns. The call no
  // longer reacts to a cancellation by itself: `events` must finish it.
  void Continue(const std::shared_ptr<StreamEvents>& events) ABSL_LOCKS_EXCLUDED(mutex_);

  // Reactions, on gRPC's threads: passed on to the events, if there are any.
  void OnWriteDone(bool ok) override ABSL_LOCKS_EXCLUDED(mutex_);
  void OnCancel() override ABSL_LOCKS_EXCLUDED(mutex_);
  void OnDone() override ABSL_LOCKS_EXCLUDED(mutex_);

 private:
  ServedCall(const Method* method, AccessGuard& guard, CallLimits& limits, grpc::GenericCallbackServerContext& context)
      : IncomingCall(guard, limits, context), method_(method) {}
  // Waits for the lane and posts Run; no thread is blocked meanwhile.
  void OnRequest() override;
  // Runs the handler; CANCELLED without running it if the client has gone. Reads the next request of a conversation.
  void Run();
  // Returns null before Continue.
  std::shared_ptr<StreamEvents> events() ABSL_LOCKS_EXCLUDED(mutex_);

  const Method* const method_;          // null only in a call that ends in Begin
  grpc::ByteBuffer outgoing_;           // of the write in progress; gRPC reads it
  std::vector<FairShare::Hold> reply_;  // of a large reply, until OnDone

  // Guards what the handler's thread shares with gRPC's. Not the mutex of IncomingCall.
  absl::Mutex mutex_;
  bool writing_ ABSL_GUARDED_BY(mutex_) = false;                  // a write is not done; Write waits for it
  bool written_ ABSL_GUARDED_BY(mutex_) = false;                  // the last write was accepted
  std::shared_ptr<StreamEvents> events_ ABSL_GUARDED_BY(mutex_);  // set once
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_CALLS_SERVED_CALL_H_
