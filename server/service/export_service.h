// v1.ExportService: records motions to files, for download.
#ifndef PHRENIC_SERVER_SERVICE_EXPORT_SERVICE_H_
#define PHRENIC_SERVER_SERVICE_EXPORT_SERVICE_H_

#include <string>

#include "phrenic/v1/export.pb.h"
#include "server/service/calls/access_guard.h"
#include "server/service/calls/call_table.h"
#include "server/session/export/exports.h"
#include "server/session/table.h"

namespace phrenic::service {

// Thread-safe: the methods run on threads of their lanes, a watcher or a download until it ends.
//
// session::Exports owns the jobs and their files, and runs them on threads of its own. A caller may watch, delete and
// download what belongs to it; everything else is NOT_FOUND. Errors as in the proto of each method.
class ExportService final {
 public:
  // All outlive the service.
  ExportService(session::Table& table, session::Exports& exports, AccessGuard& guard)
      : table_(table), exports_(exports), guard_(guard) {}

  // Adds the methods to the table. The service outlives it.
  void AddTo(CallTable& calls);

  // On Lane::kQuick.
  grpc::Status ListFormats(grpc::CallbackServerContext* context, const v1::ListFormatsRequest* request,
                           v1::ListFormatsResponse* response);
  // On Lane::kSession. Copies the session's state between two steps, and returns when the store has the job on the
  // disk. FAILED_PRECONDITION if the session has diverged.
  grpc::Status CreateExport(grpc::CallbackServerContext* context, const v1::CreateExportRequest* request,
                            v1::CreateExportResponse* response);
  // On Lane::kWatch, until the export ends or the client disconnects. CANCELLED if the export is deleted meanwhile.
  grpc::Status WatchExport(grpc::CallbackServerContext* context, const v1::WatchExportRequest* request,
                           ReplyStream<v1::WatchExportResponse>* writer);
  // On Lane::kQuick. An administrator gets all; without accounts everybody does.
  grpc::Status ListExports(grpc::CallbackServerContext* context, const v1::ListExportsRequest* request,
                           v1::ListExportsResponse* response);
  // On Lane::kSession. A download in progress keeps the file and goes on.
  grpc::Status DeleteExport(grpc::CallbackServerContext* context, const v1::DeleteExportRequest* request,
                            v1::DeleteExportResponse* response);
  // On Lane::kStream. Sends chunks of 128 KiB from `offset` [bytes] on, at the speed of the client.
  grpc::Status DownloadExport(grpc::CallbackServerContext* context, const v1::DownloadExportRequest* request,
                              ReplyStream<v1::DownloadExportResponse>* writer);

 private:
  // The errors of AccessGuard::CheckOwns.
  absl::Status CheckOwns(const std::string& id, const access::Caller& caller) const;
  // CANCELLED if the client disconnects. The errors of Exports::File and SpoolFile::Read.
  absl::Status Download(const v1::DownloadExportRequest& request,
                        ReplyStream<v1::DownloadExportResponse>& writer) const;

  session::Table& table_;
  session::Exports& exports_;
  AccessGuard& guard_;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_EXPORT_SERVICE_H_
