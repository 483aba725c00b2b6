// The responses of a streaming method.
#ifndef PHRENIC_SERVER_SERVICE_CALLS_REPLY_STREAM_H_
#define PHRENIC_SERVER_SERVICE_CALLS_REPLY_STREAM_H_

#include "server/service/calls/messages.h"
#include "server/service/calls/served_call.h"

namespace phrenic::service {

// Used by the handler's thread.
template <class Response>
class ReplyStream {
 public:
  explicit ReplyStream(ServedCall& call) : call_(call) {}

  // Waits until the client's flow control accepts the message. False if the client is gone, or has not read for a
  // minute; the handler must then return soon.
  bool Write(const Response& response) { return call_.Write(Serialize(response)); }

 private:
  ServedCall& call_;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_CALLS_REPLY_STREAM_H_
