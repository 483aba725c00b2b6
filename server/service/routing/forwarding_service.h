// The gRPC service that a cluster's server listens with: it accepts every method of a table and forwards the serialized
// messages to the server that handles the call, possibly this one.
#ifndef PHRENIC_SERVER_SERVICE_ROUTING_FORWARDING_SERVICE_H_
#define PHRENIC_SERVER_SERVICE_ROUTING_FORWARDING_SERVICE_H_

#include <grpcpp/generic/async_generic_service.h>

#include "server/service/calls/call_table.h"
#include "server/service/routing/forwarded_call.h"
#include "server/service/routing/session_router.h"

namespace phrenic::service {

// Thread-safe. The references outlive it.
//
// A server in a cluster registers it with a gRPC server of its own, the only one that listens, and passes its own calls
// in process to the server of CallTable. A call is admitted by its headers here, and again, with its request, by the
// server that handles it.
class ForwardingService final : public grpc::CallbackGenericService {
 public:
  // `calls` gives the methods and their rules; its handlers are not called. `limits` are those of this gRPC server.
  ForwardingService(SessionRouter& router, const CallTable& calls, AccessGuard& guard, CallLimits& limits)
      : router_(router), calls_(calls), guard_(guard), limits_(limits) {}

  // gRPC calls it for each call, on its own threads, when it has the headers. The call deletes itself after OnDone. A
  // method that the table lacks ends with UNIMPLEMENTED.
  grpc::ServerGenericBidiReactor* CreateReactor(grpc::GenericCallbackServerContext* context) override {
    return ForwardedCall::Make(router_, guard_, limits_, calls_.Find(context->method()), *context);
  }

 private:
  SessionRouter& router_;
  const CallTable& calls_;
  AccessGuard& guard_;
  CallLimits& limits_;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_ROUTING_FORWARDING_SERVICE_H_
