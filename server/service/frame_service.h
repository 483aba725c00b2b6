// v1.FrameService: geometry and frames. A frame is encoded once and its bytes are shared by all viewers.
#ifndef PHRENIC_SERVER_SERVICE_FRAME_SERVICE_H_
#define PHRENIC_SERVER_SERVICE_FRAME_SERVICE_H_

#include <string>

#include "phrenic/v1/frames.pb.h"
#include "server/service/calls/access_guard.h"
#include "server/service/calls/call_table.h"
#include "server/service/calls/fair_share.h"
#include "server/service/calls/metrics.h"
#include "server/session/limits.h"
#include "server/session/table.h"

namespace phrenic::service {

// Thread-safe: the methods run on threads of their lanes. WatchFrames keeps no thread (WatchReactor).
class FrameService final {
 public:
  FrameService(session::Table& table, AccessGuard& guard, Metrics& metrics, const session::Limits& limits);

  // Adds the methods to the table. The service outlives it.
  void AddTo(CallTable& calls);

  grpc::Status GetGeometry(grpc::CallbackServerContext* context, const v1::GetGeometryRequest* request,
                           ReplyStream<v1::GetGeometryResponse>* writer);
  grpc::Status AckFrames(grpc::CallbackServerContext* context, const v1::AckFramesRequest* request,
                         v1::AckFramesResponse* response);
  grpc::Status GetBasis(grpc::CallbackServerContext* context, const v1::GetBasisRequest* request,
                        v1::GetBasisResponse* response);
  grpc::Status GetForces(grpc::CallbackServerContext* context, const v1::GetForcesRequest* request,
                         v1::GetForcesResponse* response);

 private:
  // Starts the stream, which then goes on without a thread. Returns an error if it cannot start.
  absl::Status WatchFrames(ServedCall& call);
  // Takes a seat in all and one of the session for the viewer.
  absl::StatusOr<FairShare::Hold> TakeSeats(const access::Caller& caller, const std::string& session);

  session::Table& table_;
  AccessGuard& guard_;
  Metrics& metrics_;
  FairShare viewers_;  // of all sessions
  FairShare seats_;    // of one caller in one session; the publisher limits all of a session
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_FRAME_SERVICE_H_
