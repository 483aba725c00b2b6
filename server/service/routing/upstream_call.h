// A call that is passed on to a server, bytes in, bytes out, whatever the method: one request, any number of answers.
#ifndef PHRENIC_SERVER_SERVICE_ROUTING_UPSTREAM_CALL_H_
#define PHRENIC_SERVER_SERVICE_ROUTING_UPSTREAM_CALL_H_

#include <grpcpp/client_context.h>
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/client_callback.h>

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <string>

namespace phrenic::service {

// Any thread may call. The handlers are called by gRPC's threads, never two at once.
class UpstreamCall final : public grpc::ClientBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer> {
 public:
  struct Request {
    std::string method;  // "/phrenic.v1.SessionService/GetSession"
    grpc::ByteBuffer message;
    std::multimap<std::string, std::string> metadata;
    std::chrono::system_clock::time_point deadline;
  };
  struct Handlers {
    // Whether the next one is asked for at once; else by ReadNext.
    std::function<bool(const grpc::ByteBuffer& message)> message;
    // The last: nobody may call the leg afterwards.
    std::function<void(const grpc::Status& status)> done;
  };

  static std::shared_ptr<UpstreamCall> Make(Request request, Handlers handlers);
  // Once.
  void Start(grpc::GenericStub& stub);
  void ReadNext() { StartRead(&incoming_); }
  void Cancel() { context_.TryCancel(); }

  void OnReadDone(bool ok) override;
  void OnDone(const grpc::Status& status) override;

 private:
  UpstreamCall(Request request, Handlers handlers);

  Request request_;
  Handlers handlers_;
  std::shared_ptr<UpstreamCall> self_;  // gRPC's hold on it
  grpc::ClientContext context_;
  grpc::ByteBuffer incoming_;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_ROUTING_UPSTREAM_CALL_H_
