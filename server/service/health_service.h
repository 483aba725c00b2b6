// gRPC's health service (grpc.health.v1.Health), which needs no account.
#ifndef PHRENIC_SERVER_SERVICE_HEALTH_SERVICE_H_
#define PHRENIC_SERVER_SERVICE_HEALTH_SERVICE_H_

#include <atomic>

#include "server/service/calls/call_table.h"

namespace phrenic::service {

// Answers for the whole server, whatever service a request names, and does not read requests. gRPC's own health service
// reads requests of any size from anyone. Thread-safe.
class HealthService {
 public:
  // Adds the methods Check and Watch to the table. The service outlives it.
  void AddTo(CallTable& calls);

  // True if the server answers calls; false during shutdown.
  void set_serving(bool serving) { serving_ = serving; }

 private:
  std::optional<grpc::Status> Watch(ServedCall& call) const;

  std::atomic<bool> serving_ = true;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_HEALTH_SERVICE_H_
