// v1.FrameService: geometry and frames. A frame is encoded once and its bytes are shared by all viewers.
#ifndef PHRENIC_SERVER_SERVICE_FRAME_SERVICE_H_
#define PHRENIC_SERVER_SERVICE_FRAME_SERVICE_H_

#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "phrenic/v1/frames.pb.h"
#include "server/service/calls/access_guard.h"
#include "server/service/calls/call_table.h"
#include "server/service/calls/fair_share.h"
#include "server/service/calls/metrics.h"
#include "server/service/calls/turn.h"
#include "server/service/net/metadata.h"
#include "server/service/watch/watch_claims.h"
#include "server/session/limits.h"
#include "server/session/table.h"

namespace phrenic::service {

// Thread-safe: the methods run on threads of their lanes. WatchFrames keeps no thread (WatchStream).
//
// Each session's Publisher encodes frames on its own thread; the service adds viewers to it. Errors as in the proto of
// each method.
class FrameService final {
 public:
  // The references outlive the service. `watches`: claims of streams that the web gateway sends.
  FrameService(session::Table& table, AccessGuard& guard, Metrics& metrics, const session::Limits& limits,
               WatchClaims& watches);

  // Adds the methods to the table. The service outlives it.
  void AddTo(CallTable& calls);

  // On Lane::kStream. The geometry is constant, so a session may step meanwhile. OK also if the client disconnects.
  grpc::Status GetGeometry(grpc::CallbackServerContext* context, const v1::GetGeometryRequest* request,
                           ReplyStream<v1::GetGeometryResponse>* writer);
  // On Lane::kQuick. Not counted towards the rate of requests. The response is the viewer's flow control.
  grpc::Status AckFrames(grpc::CallbackServerContext* context, const v1::AckFramesRequest* request,
                         v1::AckFramesResponse* response);
  // The same for a call of a browser, without gRPC: returns the serialized response or the error, on the calling
  // thread. Does not block. nullopt if the session is not this server's or the message is not valid: the call is then
  // to be made. `metadata` is that of the call, with kPeerKey.
  std::optional<absl::StatusOr<std::string>> AckFramesAtOnce(const Metadata& metadata, const std::string& message);
  // On Lane::kQuick. The response is empty before the session's first basis.
  grpc::Status GetBasis(grpc::CallbackServerContext* context, const v1::GetBasisRequest* request,
                        v1::GetBasisResponse* response);
  // On Lane::kSession. Waits for a copy of the state between two steps and evaluates the forces [N] on the lane's
  // thread. RESOURCE_EXHAUSTED, before that, if the caller has too many large replies: the forces of a state count as
  // two of its arrays.
  grpc::Status GetForces(ServedCall& call, const v1::GetForcesRequest& request, v1::GetForcesResponse* response);

 private:
  // Starts the stream, which then goes on without a thread. Returns an error if it cannot start. On Lane::kQuick until
  // the stream has started; a WatchReactor then serves the viewer, or the gateway by a ClaimedWatch. RESOURCE_EXHAUSTED
  // above the limits of viewers, ALREADY_EXISTS for a watch_id that another viewer of the session has, INVALID_ARGUMENT
  // for an unknown body, or for max_unacked_frames without a watch_id.
  absl::Status WatchFrames(ServedCall& call);
  // Takes a seat in all and one of the session for the viewer. The result holds both until it is destroyed.
  // RESOURCE_EXHAUSTED names the limit and its flag.
  absl::StatusOr<FairShare::Hold> TakeSeats(const access::Caller& caller, const std::string& session);

  // Waits for the caller's turn if a read is as large as that [bytes] (AwaitTurn). CANCELLED if the client has gone
  // meanwhile.
  absl::StatusOr<FairShare::Hold> TakeTurn(const access::Caller& caller, const grpc::ServerContextBase& context,
                                           std::size_t bytes);

  session::Table& table_;
  AccessGuard& guard_;
  Metrics& metrics_;
  WatchClaims& watches_;
  FairShare viewers_;                    // of all sessions
  FairShare seats_;                      // of one caller in one session; the publisher limits all of a session
  FairShare large_reads_{LargeReads()};  // of GetGeometry and GetForces
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_FRAME_SERVICE_H_
