// v1::SampleService: a session's measures, sampled by simulated time.
#ifndef PHRENIC_SERVER_SERVICE_SAMPLE_SERVICE_H_
#define PHRENIC_SERVER_SERVICE_SAMPLE_SERVICE_H_

#include <string>

#include "phrenic/v1/samples.pb.h"
#include "server/service/calls/access_guard.h"
#include "server/service/calls/call_table.h"
#include "server/service/calls/fair_share.h"
#include "server/session/limits.h"
#include "server/session/table.h"

namespace phrenic::service {

// Thread-safe: the methods run on threads of their lanes. WatchSamples keeps no thread (SampleReactor). The session's
// stream::Sampler takes the samples. Errors as in the proto of each method.
class SampleService final {
 public:
  // Table and guard outlive the service.
  SampleService(session::Table& table, AccessGuard& guard, const session::Limits& limits);

  // Adds the methods to the table. The service outlives it.
  void AddTo(CallTable& calls);

  // On Lane::kSession: a read without a valid position waits for the step in progress, and alone counts towards the
  // rate of requests.
  grpc::Status ReadSamples(grpc::CallbackServerContext* context, const v1::ReadSamplesRequest* request,
                           v1::ReadSamplesResponse* response);

 private:
  // Starts the stream, which then goes on without a thread. On Lane::kSession until it has started.
  // RESOURCE_EXHAUSTED above the limits of viewers, which streams of frames and of samples have each.
  absl::Status WatchSamples(ServedCall& call);
  // Takes a seat in all and one of the session.
  absl::StatusOr<FairShare::Hold> TakeSeats(const access::Caller& caller, const std::string& session);

  session::Table& table_;
  AccessGuard& guard_;
  FairShare readers_;  // of all sessions
  FairShare seats_;    // of one session
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_SAMPLE_SERVICE_H_
