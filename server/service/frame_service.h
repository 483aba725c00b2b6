// Geometry and frames over gRPC: bytes that are encoded once and shared by everybody who is sent them.
#ifndef PHRENIC_SERVER_SERVICE_FRAME_SERVICE_H_
#define PHRENIC_SERVER_SERVICE_FRAME_SERVICE_H_

#include "phrenic/v1/frames.grpc.pb.h"
#include "server/session/table.h"

namespace phrenic::service {

// gRPC's threads call, any number at a time. Neither WatchFrames nor AckFrames keeps a thread waiting: viewers are
// served by callbacks.
class FrameService final : public v1::FrameService::WithRawCallbackMethod_WatchFrames<
                               v1::FrameService::WithCallbackMethod_AckFrames<v1::FrameService::Service>> {
 public:
  explicit FrameService(session::Table& table) : table_(table) {}

  grpc::Status GetGeometry(grpc::ServerContext* context, const v1::GetGeometryRequest* request,
                           grpc::ServerWriter<v1::GetGeometryResponse>* writer) override;
  grpc::ServerWriteReactor<grpc::ByteBuffer>* WatchFrames(grpc::CallbackServerContext* context,
                                                          const grpc::ByteBuffer* request) override;
  grpc::ServerUnaryReactor* AckFrames(grpc::CallbackServerContext* context, const v1::AckFramesRequest* request,
                                      v1::AckFramesResponse* response) override;
  grpc::Status GetForces(grpc::ServerContext* context, const v1::GetForcesRequest* request,
                         v1::GetForcesResponse* response) override;

 private:
  session::Table& table_;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_FRAME_SERVICE_H_
