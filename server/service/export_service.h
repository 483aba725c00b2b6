// v1.ExportService: records motions to files, for download.
#ifndef PHRENIC_SERVER_SERVICE_EXPORT_SERVICE_H_
#define PHRENIC_SERVER_SERVICE_EXPORT_SERVICE_H_

#include <atomic>

#include "phrenic/v1/export.grpc.pb.h"
#include "server/service/calls/access_guard.h"
#include "server/session/export/exports.h"
#include "server/session/table.h"

namespace phrenic::service {

// Thread-safe: gRPC calls the methods on its own threads. A watcher or a download occupies a thread until it ends;
// RESOURCE_EXHAUSTED above 32 of them.
class ExportService final : public v1::ExportService::Service {
 public:
  ExportService(session::Table& table, session::Exports& exports, AccessGuard& guard)
      : table_(table), exports_(exports), guard_(guard) {}

  grpc::Status ListFormats(grpc::ServerContext* context, const v1::ListFormatsRequest* request,
                           v1::ListFormatsResponse* response) override;
  grpc::Status CreateExport(grpc::ServerContext* context, const v1::CreateExportRequest* request,
                            v1::CreateExportResponse* response) override;
  grpc::Status WatchExport(grpc::ServerContext* context, const v1::WatchExportRequest* request,
                           grpc::ServerWriter<v1::WatchExportResponse>* writer) override;
  grpc::Status ListExports(grpc::ServerContext* context, const v1::ListExportsRequest* request,
                           v1::ListExportsResponse* response) override;
  grpc::Status DeleteExport(grpc::ServerContext* context, const v1::DeleteExportRequest* request,
                            v1::DeleteExportResponse* response) override;
  grpc::Status DownloadExport(grpc::ServerContext* context, const v1::DownloadExportRequest* request,
                              grpc::ServerWriter<v1::DownloadExportResponse>* writer) override;

 private:
  absl::Status Watch(const std::string& id, grpc::ServerContext& context,
                     grpc::ServerWriter<v1::WatchExportResponse>& writer) const;
  absl::Status Download(const v1::DownloadExportRequest& request,
                        grpc::ServerWriter<v1::DownloadExportResponse>& writer) const;

  session::Table& table_;
  session::Exports& exports_;
  AccessGuard& guard_;
  std::atomic<int> streams_ = 0;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_EXPORT_SERVICE_H_
