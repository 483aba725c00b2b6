// Motions as files over gRPC.
#ifndef PHRENIC_SERVER_SERVICE_EXPORT_SERVICE_H_
#define PHRENIC_SERVER_SERVICE_EXPORT_SERVICE_H_

#include <atomic>

#include "phrenic/v1/export.grpc.pb.h"
#include "server/session/table.h"

namespace phrenic::service {

// gRPC's threads call, any number at a time; each export has one of them until it is done. A receiver that reads
// slowly holds its export up, and one that goes away ends it.
class ExportService final : public v1::ExportService::Service {
 public:
  ExportService(session::Table& table, int max_exports) : table_(table), max_exports_(max_exports) {}

  grpc::Status ListFormats(grpc::ServerContext* context, const v1::ListFormatsRequest* request,
                           v1::ListFormatsResponse* response) override;
  grpc::Status ExportMotion(grpc::ServerContext* context, const v1::ExportMotionRequest* request,
                            grpc::ServerWriter<v1::ExportMotionResponse>* writer) override;

 private:
  session::Table& table_;
  const int max_exports_;
  std::atomic<int> exports_ = 0;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_EXPORT_SERVICE_H_
