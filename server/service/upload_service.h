// v1.UploadService: surface files from clients, in chunks that can be resumed.
#ifndef PHRENIC_SERVER_SERVICE_UPLOAD_SERVICE_H_
#define PHRENIC_SERVER_SERVICE_UPLOAD_SERVICE_H_

#include "phrenic/v1/upload.grpc.pb.h"
#include "server/service/calls/access_guard.h"
#include "server/session/uploads.h"

namespace phrenic::service {

// Thread-safe: gRPC calls the methods on its own threads. Errors as in the proto of each method.
class UploadService final : public v1::UploadService::Service {
 public:
  UploadService(session::Uploads& uploads, const session::Limits& limits, AccessGuard& guard)
      : uploads_(uploads), limits_(limits), guard_(guard) {}

  grpc::Status ListSurfaceFormats(grpc::ServerContext* context, const v1::ListSurfaceFormatsRequest* request,
                                  v1::ListSurfaceFormatsResponse* response) override;
  grpc::Status BeginUpload(grpc::ServerContext* context, const v1::BeginUploadRequest* request,
                           v1::BeginUploadResponse* response) override;
  grpc::Status AddUploadChunk(grpc::ServerContext* context, const v1::AddUploadChunkRequest* request,
                              v1::AddUploadChunkResponse* response) override;
  grpc::Status FinishUpload(grpc::ServerContext* context, const v1::FinishUploadRequest* request,
                            v1::FinishUploadResponse* response) override;
  grpc::Status ListUploads(grpc::ServerContext* context, const v1::ListUploadsRequest* request,
                           v1::ListUploadsResponse* response) override;
  grpc::Status DeleteUpload(grpc::ServerContext* context, const v1::DeleteUploadRequest* request,
                            v1::DeleteUploadResponse* response) override;

 private:
  session::Uploads& uploads_;
  const session::Limits limits_;
  AccessGuard& guard_;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_UPLOAD_SERVICE_H_
