// v1.FrameService: geometry and frames. A frame is encoded once and its bytes are shared by all viewers.
#ifndef PHRENIC_SERVER_SERVICE_FRAME_SERVICE_H_
#define PHRENIC_SERVER_SERVICE_FRAME_SERVICE_H_

#include <atomic>
#include <memory>

#include "phrenic/v1/frames.grpc.pb.h"
#include "server/service/calls/access_guard.h"
#include "server/service/calls/metrics.h"
#include "server/service/watch_reactor.h"
#include "server/session/table.h"

namespace phrenic::service {

// Thread-safe: gRPC calls the methods on its own threads. WatchFrames and AckFrames use the callback API, so that
// viewers occupy no threads.
class FrameService final : public v1::FrameService::WithRawCallbackMethod_WatchFrames<
                               v1::FrameService::WithCallbackMethod_AckFrames<v1::FrameService::Service>> {
 public:
  FrameService(session::Table& table, AccessGuard& guard, Metrics& metrics, int max_viewers)
      : table_(table), guard_(guard), metrics_(metrics), max_viewers_(max_viewers) {}

  grpc::Status GetGeometry(grpc::ServerContext* context, const v1::GetGeometryRequest* request,
                           grpc::ServerWriter<v1::GetGeometryResponse>* writer) override;
  grpc::ServerWriteReactor<grpc::ByteBuffer>* WatchFrames(grpc::CallbackServerContext* context,
                                                          const grpc::ByteBuffer* request) override;
  grpc::ServerUnaryReactor* AckFrames(grpc::CallbackServerContext* context, const v1::AckFramesRequest* request,
                                      v1::AckFramesResponse* response) override;
  grpc::Status GetBasis(grpc::ServerContext* context, const v1::GetBasisRequest* request,
                        v1::GetBasisResponse* response) override;
  grpc::Status GetForces(grpc::ServerContext* context, const v1::GetForcesRequest* request,
                         v1::GetForcesResponse* response) override;

 private:
  // Starts the stream on the reactor. Returns an error, with which the caller refuses it, if the request is not valid.
  absl::Status Watch(const grpc::CallbackServerContext& context, const grpc::ByteBuffer& bytes, WatchReactor& reactor);

  session::Table& table_;
  AccessGuard& guard_;
  Metrics& metrics_;
  const int max_viewers_;  // over all sessions
  std::shared_ptr<std::atomic<int>> viewers_ = std::make_shared<std::atomic<int>>(0);
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_FRAME_SERVICE_H_
