// v1.CompareService: compares surfaces and motions.
#ifndef PHRENIC_SERVER_SERVICE_COMPARE_SERVICE_H_
#define PHRENIC_SERVER_SERVICE_COMPARE_SERVICE_H_

#include <atomic>

#include "phrenic/v1/compare.grpc.pb.h"
#include "server/service/calls/access_guard.h"
#include "server/session/table.h"

namespace phrenic::service {

// Thread-safe: gRPC calls the methods on its own threads. A comparison occupies a thread until it is done or its caller
// disconnects; RESOURCE_EXHAUSTED above `max_comparisons` at a time.
class CompareService final : public v1::CompareService::Service {
 public:
  CompareService(const session::Table& table, int max_comparisons, AccessGuard& guard)
      : table_(table), max_comparisons_(max_comparisons), guard_(guard) {}

  grpc::Status Compare(grpc::ServerContext* context, const v1::CompareRequest* request,
                       grpc::ServerWriter<v1::CompareResponse>* writer) override;

 private:
  const session::Table& table_;
  const int max_comparisons_;
  AccessGuard& guard_;
  std::atomic<int> comparisons_ = 0;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_COMPARE_SERVICE_H_
