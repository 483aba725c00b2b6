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
//
// ForwardedCall makes one for each target. The object holds itself from Make until `done` has run, so a call that is
// not started is never destroyed. The handlers hold the ForwardedCall.
class UpstreamCall final : public grpc::ClientBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer> {
 public:
  // A call that is to be made. Plain data.
  struct Request {
    std::string method;                              // "/phrenic.v1.SessionService/GetSession"
    grpc::ByteBuffer message;                        // serialized; the only one
    Metadata metadata;                               // checked by Start
    std::chrono::system_clock::time_point deadline;  // time_point::max(): none
  };
  // The handlers must not block.
  struct Handlers {
    // Returns true to read the next message at once; after false the owner calls ReadNext.
    std::function<bool(const grpc::ByteBuffer& message)> message;
    // Called last. Only Cancel may be called afterwards, without effect. Called exactly once, also after an error, a
    // timeout or Cancel.
    std::function<void(const grpc::Status& status)> done;
  };

  static std::shared_ptr<UpstreamCall> Make(Request request, Handlers handlers);
  // Call once. Errors of PrepareContext reach the handler `done`, possibly before Start returns. Reads the first
  // message. The stub lives until Start returns.
  void Start(grpc::GenericStub& stub);
  // Requires: `message` has returned false for the previous one.
  void ReadNext() { StartRead(&incoming_); }
  // The call then ends with CANCELLED, if it has not ended. May be called before Start.
  void Cancel() { context_.TryCancel(); }

  // Reactions of gRPC, on its threads.
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
