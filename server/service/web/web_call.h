// One gRPC call made for a browser: bytes in, bytes out, whatever the method.
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
#include <optional>
#include <string>

namespace phrenic::service {

// All of its functions are called on `strand`, and so are the two handlers. Unary calls are streams of one message.
class WebCall final : public grpc::ClientBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer>,
                      public std::enable_shared_from_this<WebCall> {
 public:
  struct Request {
    std::string method;  // "/phrenic.v1.SessionService/GetSession"
    std::string message;
    std::multimap<std::string, std::string> metadata;
    std::optional<std::chrono::nanoseconds> timeout;
  };
  struct Handlers {
    std::function<void(const grpc::ByteBuffer& message)> message;
    std::function<void(const grpc::Status& status, const std::multimap<std::string, std::string>& trailers)> done;
  };

  static std::shared_ptr<WebCall> Start(grpc::GenericStub& stub, Request request,
                                        const boost::asio::any_io_executor& strand, Handlers handlers);

  // Asks for the next message; the first one is asked for by Start. No message is read before it is asked for, so that
  // a slow browser holds up its own call only.
  void ReadNext();
  // Nobody listens any more: the call is cancelled, and neither handler is called again.
  void Abandon();

  void OnReadDone(bool ok) override;
  void OnDone(const grpc::Status& status) override;

 private:
  WebCall(Request request, const boost::asio::any_io_executor& strand, Handlers handlers);
  void ReadDone(bool ok, const grpc::ByteBuffer& message);
  // Lets the call end once no read is to come.
  void LetGo();

  Request request_;
  boost::asio::any_io_executor strand_;
  // Keeps the gateway's threads until the call is over.
  std::optional<boost::asio::executor_work_guard<boost::asio::any_io_executor>> work_;
  Handlers handlers_;
  std::shared_ptr<WebCall> self_;  // gRPC's hold on it
  grpc::ClientContext context_;
  grpc::ByteBuffer outgoing_, incoming_;
  bool reading_ = false;
  bool held_ = false;
  bool abandoned_ = false;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_WEB_WEB_CALL_H_
