// One gRPC call on behalf of a browser, for any method: serialized messages in and out.
#ifndef PHRENIC_SERVER_SERVICE_WEB_WEB_CALL_H_
#define PHRENIC_SERVER_SERVICE_WEB_WEB_CALL_H_

#include <utility>
// Boost 1.74's Asio needs <utility> before it with C++20.
#include <grpcpp/client_context.h>
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/client_callback.h>

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/executor_work_guard.hpp>
#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "server/service/net/metadata.h"

namespace phrenic::service {

// Not thread-safe: call its methods on `strand`, which also runs the handlers; gRPC's threads call the reactor's
// overrides. A unary call is handled as a stream of one message.
//
// WebConnection makes one for each gRPC-web request and reads the messages one by one. The object holds itself until
// gRPC has ended the call, and the handlers hold the connection until the call has ended or is cancelled. The
// io_context of the strand keeps running meanwhile.
class WebCall final : public grpc::ClientBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>,
                      public std::enable_shared_from_this<WebCall> {
 public:
  // A call that is to be made. Plain data.
  struct Request {
    std::string method;                               // "/phrenic.v1.SessionService/GetSession"
    std::string message;                              // serialized
    Metadata metadata;                                // checked by Start
    std::optional<std::chrono::nanoseconds> timeout;  // from Start on; nullopt: no deadline
  };
  // The handlers run on the strand. `message` is called for each read that finds a message, and `done` once, last;
  // neither after Cancel.
  struct Handlers {
    std::function<void(const grpc::ByteBuffer& message)> message;
    std::function<void(const grpc::Status& status, const std::multimap<std::string, std::string>& trailers)> done;
  };

  // Starts the call and reads the first message. Errors, without a call of a handler: those of PrepareContext. `stub`
  // lives until Start returns.
  static absl::StatusOr<std::shared_ptr<WebCall>> Start(grpc::GenericStub& stub, Request request,
                                                        const boost::asio::any_io_executor& strand, Handlers handlers);

  // Reads the next message. Call it after the previous message is written to the browser: HTTP/2 flow control then
  // limits what a slow browser can queue, and only its own call waits. Does nothing while a read is in progress, after
  // Cancel, and after the end of the messages.
  void ReadNext();
  // Cancels the call. No handler is called afterwards. Releases the handlers. Idempotent, and without effect on a call
  // that has ended.
  void Cancel();

  // Reactions, on gRPC's threads. They post the event to the strand.
  void OnReadDone(bool ok) override;
  void OnDone(const grpc::Status& status) override;

 private:
  WebCall(const boost::asio::any_io_executor& strand, Handlers handlers);
  // OnReadDone on the strand. Without `ok` there are no further messages.
  void HandleRead(bool ok, const grpc::ByteBuffer& message);
  // Allows gRPC to call OnDone. Requires: no read is started afterwards.
  void ReleaseHold();

  boost::asio::any_io_executor strand_;
  // Keeps the gateway's threads running until the call ends.
  std::optional<boost::asio::executor_work_guard<boost::asio::any_io_executor>> work_;
  Handlers handlers_;              // empty after the end
  std::shared_ptr<WebCall> self_;  // keeps the reactor alive until OnDone
  // Held while gRPC's thread posts the end of the call: post uses the strand until it returns, and once the end is
  // handled the strand's context may be gone.
  std::mutex posting_;
  grpc::ClientContext context_;
  grpc::ByteBuffer outgoing_, incoming_;  // the request; the message being read
  bool reading_ = false;                  // a read was started and is not handled
  bool held_ = false;                     // gRPC waits for ReleaseHold
  bool cancelled_ = false;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_WEB_WEB_CALL_H_
