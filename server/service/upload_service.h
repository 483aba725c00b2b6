// v1.UploadService: surface files and label volumes from clients, in chunks that can be resumed.
#ifndef PHRENIC_SERVER_SERVICE_UPLOAD_SERVICE_H_
#define PHRENIC_SERVER_SERVICE_UPLOAD_SERVICE_H_

#include "phrenic/v1/upload.pb.h"
#include "server/service/calls/access_guard.h"
#include "server/service/calls/call_table.h"
#include "server/session/uploads.h"

namespace phrenic::service {

// Thread-safe: the methods run on threads of their lanes. Errors as in the proto of each method.
//
// session::Uploads owns the files, which vanish when the server ends; the service has no state and no lock. A file
// belongs to those who have sent its bytes, and to others it does not exist (NOT_FOUND).
class UploadService final {
 public:
  // Uploads and guard outlive the service.
  UploadService(session::Uploads& uploads, const session::Limits& limits, AccessGuard& guard)
      : uploads_(uploads), limits_(limits), guard_(guard) {}

  // Adds the methods to the table. The service outlives it.
  void AddTo(CallTable& calls);

  // On Lane::kQuick. most_bytes is the limit of one file [bytes].
  grpc::Status ListSurfaceFormats(grpc::CallbackServerContext* context, const v1::ListSurfaceFormatsRequest* request,
                                  v1::ListSurfaceFormatsResponse* response);
  // On Lane::kSession. The id is empty if the caller has uploaded the same bytes before: nothing is to be sent then.
  grpc::Status BeginUpload(grpc::CallbackServerContext* context, const v1::BeginUploadRequest* request,
                           v1::BeginUploadResponse* response);
  // On Lane::kSession. `received` is the number of bytes that the server has, from the start of the file. Bytes that it
  // has already are skipped.
  grpc::Status AddUploadChunk(grpc::CallbackServerContext* context, const v1::AddUploadChunkRequest* request,
                              v1::AddUploadChunkResponse* response);
  // On Lane::kWork, since it parses and inspects the surface. 1 mm per unit if the request has no unit_mm.
  grpc::Status FinishUpload(grpc::CallbackServerContext* context, const v1::FinishUploadRequest* request,
                            v1::FinishUploadResponse* response);
  // On Lane::kQuick.
  grpc::Status ListUploads(grpc::CallbackServerContext* context, const v1::ListUploadsRequest* request,
                           v1::ListUploadsResponse* response);
  // On Lane::kSession. Sessions that use the file keep it.
  grpc::Status DeleteUpload(grpc::CallbackServerContext* context, const v1::DeleteUploadRequest* request,
                            v1::DeleteUploadResponse* response);

 private:
  session::Uploads& uploads_;
  const session::Limits limits_;
  AccessGuard& guard_;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_UPLOAD_SERVICE_H_
