// v1.ExportService: records motions to files, for download.
#ifndef PHRENIC_SERVER_SERVICE_EXPORT_SERVICE_H_
#define PHRENIC_SERVER_SERVICE_EXPORT_SERVICE_H_

#include "phrenic/v1/export.pb.h"
#include "server/service/calls/access_guard.h"
#include "server/service/calls/call_table.h"
#include "server/session/export/exports.h"
#include "server/session/table.h"

namespace phrenic::service {

// Thread-safe: the methods run on threads of their lanes, a watcher or a download until it ends.
class ExportService final {
 public:
  ExportService(session::Table& table, session::Exports& exports, AccessGuard& guard)
      : table_(table), exports_(exports), guard_(guard) {}

  // Adds the methods to the table. The service outlives it.
  void AddTo(CallTable& calls);

  grpc::Status ListFormats(grpc::CallbackServerContext* context, const v1::ListFormatsRequest* request,
                           v1::ListFormatsResponse* response);
  grpc::Status CreateExport(grpc::CallbackServerContext* context, const v1::CreateExportRequest* request,
                            v1::CreateExportResponse* response);
  grpc::Status WatchExport(grpc::CallbackServerContext* context, const v1::WatchExportRequest* request,
                           ReplyStream<v1::WatchExportResponse>* writer);
  grpc::Status ListExports(grpc::CallbackServerContext* context, const v1::ListExportsRequest* request,
                           v1::ListExportsResponse* response);
  grpc::Status DeleteExport(grpc::CallbackServerContext* context, const v1::DeleteExportRequest* request,
                            v1::DeleteExportResponse* response);
  grpc::Status DownloadExport(grpc::CallbackServerContext* context, const v1::DownloadExportRequest* request,
                              ReplyStream<v1::DownloadExportResponse>* writer);

 private:
  absl::Status Download(const v1::DownloadExportRequest& request,
                        ReplyStream<v1::DownloadExportResponse>& writer) const;

  session::Table& table_;
  session::Exports& exports_;
  AccessGuard& guard_;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_EXPORT_SERVICE_H_
