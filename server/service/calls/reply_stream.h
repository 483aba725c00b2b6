// The responses of a streaming method.
#ifndef PHRENIC_SERVER_SERVICE_CALLS_REPLY_STREAM_H_
#define PHRENIC_SERVER_SERVICE_CALLS_REPLY_STREAM_H_

#include "server/service/calls/messages.h"
#include "server/service/calls/served_call.h"

namespace phrenic::service {

// Used by the handler's thread. CallTable makes one for each call of a streaming handler; the call outlives it. Not
// thread-safe: one write at a time.
template <class Response>
class ReplyStream {
 public:
  explicit ReplyStream(ServedCall& call) : call_(call) {}

  // Waits until the client's flow control accepts the message. False if the client is gone, or has not read for a
  // minute; the handler must then return soon. After false the status that the handler returns does not reach the
  // client. The server sets no limit on the size of a message, so services send long data in chunks.
  bool Write(const Response& response) { return call_.Write(Serialize(response)); }

  // Asks whether a message of so many bytes may be sent, before it is made (ServedCall::Reserve).
  absl::Status Reserve(std::size_t bytes) { return call_.Reserve(bytes); }

 private:
  ServedCall& call_;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_CALLS_REPLY_STREAM_H_
