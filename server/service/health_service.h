// gRPC's health service (grpc.health.v1.Health), which needs no account.
#ifndef PHRENIC_SERVER_SERVICE_HEALTH_SERVICE_H_
#define PHRENIC_SERVER_SERVICE_HEALTH_SERVICE_H_

#include <atomic>

#include "server/service/calls/call_table.h"

namespace phrenic::service {

// Answers for the whole server, whatever service a request names, and does not read requests. gRPC's own health service
// reads requests of any size from anyone. Thread-safe.
//
// Load balancers and `grpcurl` ask it. It says whether the server is shutting down, not whether calls get through:
// /readyz does (WebPages).
class HealthService {
 public:
  // Adds the methods Check and Watch to the table. The service outlives it. Check is on Lane::kQuick. Watch is on
  // Lane::kWatch and keeps its thread until the client goes.
  void AddTo(CallTable& calls);

  // True if the server answers calls; false during shutdown. Watchers learn of it within 0.2 s. Server::Shutdown calls
  // it.
  void set_serving(bool serving) { serving_ = serving; }

 private:
  // Writes the state at once and after each change, and looks at it five times a second. Ends with CANCELLED.
  std::optional<grpc::Status> Watch(ServedCall& call) const;

  std::atomic<bool> serving_ = true;  // written by Server, read by the lanes
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_HEALTH_SERVICE_H_
