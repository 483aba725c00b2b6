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
class WebCall final : public grpc::ClientBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>,
                      public std::enable_shared_from_this<WebCall> {
 public:
  struct Request {
    std::string method;  // "/phrenic.v1.SessionService/GetSession"
    std::string message;
    Metadata metadata;
    std::optional<std::chrono::nanoseconds> timeout;
  };
  struct Handlers {
    std::function<void(const grpc::ByteBuffer& message)> message;
    std::function<void(const grpc::Status& status, const std::multimap<std::string, std::string>& trailers)> done;
  };

  // Starts the call and reads the first message. Errors, without a call of a handler: those of PrepareContext.
  static absl::StatusOr<std::shared_ptr<WebCall>> Start(grpc::GenericStub& stub, Request request,
                                                        const boost::asio::any_io_executor& strand, Handlers handlers);

  // Reads the next message. Call it after the previous message is written to the browser: HTTP/2 flow control then
  // limits what a slow browser can queue, and only its own call waits.
  void ReadNext();
  // Cancels the call. No handler is called afterwards.
  void Cancel();

  void OnReadDone(bool ok) override;
  void OnDone(const grpc::Status& status) override;

 private:
  WebCall(const boost::asio::any_io_executor& strand, Handlers handlers);
  void HandleRead(bool ok, const grpc::ByteBuffer& message);
  // Allows gRPC to call OnDone. Requires: no read is started afterwards.
  void ReleaseHold();

  boost::asio::any_io_executor strand_;
  // Keeps the gateway's threads running until the call ends.
  std::optional<boost::asio::executor_work_guard<boost::asio::any_io_executor>> work_;
  Handlers handlers_;
  std::shared_ptr<WebCall> self_;  // keeps the reactor alive until OnDone
  // Held while gRPC's thread posts the end of the call: post uses the strand until it returns, and once the end is
  // handled the strand's context may be gone.
  std::mutex posting_;
  grpc::ClientContext context_;
  grpc::ByteBuffer outgoing_, incoming_;
  bool reading_ = false;
  bool held_ = false;
  bool cancelled_ = false;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_WEB_WEB_CALL_H_
