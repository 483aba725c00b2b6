// The gRPC service that a cluster's server listens with: it accepts every method and forwards the serialized messages
// to the server that handles the call, possibly this one.
#ifndef PHRENIC_SERVER_SERVICE_ROUTING_FORWARDING_SERVICE_H_
#define PHRENIC_SERVER_SERVICE_ROUTING_FORWARDING_SERVICE_H_

#include <grpcpp/generic/async_generic_service.h>

#include "server/service/routing/forwarded_call.h"
#include "server/service/routing/session_router.h"

namespace phrenic::service {

// Thread-safe. The router outlives it.
class ForwardingService final : public grpc::CallbackGenericService {
 public:
  explicit ForwardingService(SessionRouter& router) : router_(router) {}

  grpc::ServerGenericBidiReactor* CreateReactor(grpc::GenericCallbackServerContext* context) override {
    return ForwardedCall::Make(router_, *context);
  }

 private:
  SessionRouter& router_;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_ROUTING_FORWARDING_SERVICE_H_
