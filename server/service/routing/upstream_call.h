// A gRPC call to the server that handles a forwarded call, for any method: one serialized request, any number of
// serialized responses.
#ifndef PHRENIC_SERVER_SERVICE_ROUTING_UPSTREAM_CALL_H_
#define PHRENIC_SERVER_SERVICE_ROUTING_UPSTREAM_CALL_H_

#include <grpcpp/client_context.h>
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/client_callback.h>

#include <chrono>
#include <functional>
#include <memory>
#include <string>

#include "server/service/net/metadata.h"

namespace phrenic::service {

// Thread-safe. gRPC's threads call the handlers, one at a time.
class UpstreamCall final : public grpc::ClientBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer> {
 public:
  struct Request {
    std::string method;  // "/phrenic.v1.SessionService/GetSession"
    grpc::ByteBuffer message;
    Metadata metadata;
    std::chrono::system_clock::time_point deadline;
  };
  struct Handlers {
    // Returns true to read the next message at once; after false the owner calls ReadNext.
    std::function<bool(const grpc::ByteBuffer& message)> message;
    // Called last. No method may be called afterwards.
    std::function<void(const grpc::Status& status)> done;
  };

  static std::shared_ptr<UpstreamCall> Make(Request request, Handlers handlers);
  // Call once. Errors of PrepareContext reach the handler `done`, possibly before Start returns.
  void Start(grpc::GenericStub& stub);
  void ReadNext() { StartRead(&incoming_); }
  void Cancel() { context_.TryCancel(); }

  void OnReadDone(bool ok) override;
  void OnDone(const grpc::Status& status) override;

 private:
  UpstreamCall(Request request, Handlers handlers);

  Request request_;
  Handlers handlers_;
  std::shared_ptr<UpstreamCall> self_;  // keeps the reactor alive until OnDone
  grpc::ClientContext context_;
  grpc::ByteBuffer incoming_;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_ROUTING_UPSTREAM_CALL_H_
