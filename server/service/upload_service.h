// v1.UploadService: surface files from clients, in chunks that can be resumed.
#ifndef PHRENIC_SERVER_SERVICE_UPLOAD_SERVICE_H_
#define PHRENIC_SERVER_SERVICE_UPLOAD_SERVICE_H_

#include "phrenic/v1/upload.pb.h"
#include "server/service/calls/access_guard.h"
#include "server/service/calls/call_table.h"
#include "server/session/uploads.h"

namespace phrenic::service {

// Thread-safe: the methods run on threads of their lanes. Errors as in the proto of each method.
class UploadService final {
 public:
  UploadService(session::Uploads& uploads, const session::Limits& limits, AccessGuard& guard)
      : uploads_(uploads), limits_(limits), guard_(guard) {}

  // Adds the methods to the table. The service outlives it.
  void AddTo(CallTable& calls);

  grpc::Status ListSurfaceFormats(grpc::CallbackServerContext* context, const v1::ListSurfaceFormatsRequest* request,
                                  v1::ListSurfaceFormatsResponse* response);
  grpc::Status BeginUpload(grpc::CallbackServerContext* context, const v1::BeginUploadRequest* request,
                           v1::BeginUploadResponse* response);
  grpc::Status AddUploadChunk(grpc::CallbackServerContext* context, const v1::AddUploadChunkRequest* request,
                              v1::AddUploadChunkResponse* response);
  grpc::Status FinishUpload(grpc::CallbackServerContext* context, const v1::FinishUploadRequest* request,
                            v1::FinishUploadResponse* response);
  grpc::Status ListUploads(grpc::CallbackServerContext* context, const v1::ListUploadsRequest* request,
                           v1::ListUploadsResponse* response);
  grpc::Status DeleteUpload(grpc::CallbackServerContext* context, const v1::DeleteUploadRequest* request,
                            v1::DeleteUploadResponse* response);

 private:
  session::Uploads& uploads_;
  const session::Limits limits_;
  AccessGuard& guard_;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_UPLOAD_SERVICE_H_
