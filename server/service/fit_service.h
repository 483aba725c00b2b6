// v1.FitService: a person's lungs and breath from landmarks, and those of many people.
#ifndef PHRENIC_SERVER_SERVICE_FIT_SERVICE_H_
#define PHRENIC_SERVER_SERVICE_FIT_SERVICE_H_

#include "phrenic/v1/fit.pb.h"
#include "server/fit/scene_lungs.h"
#include "server/service/calls/access_guard.h"
#include "server/service/calls/call_table.h"
#include "server/service/calls/fair_share.h"
#include "server/session/limits.h"
#include "server/session/models.h"

namespace phrenic::service {

// Thread-safe: the methods run on a thread of its lane until the fit is done or its caller disconnects.
class FitService final {
 public:
  // Models and guard outlive the service. limits.exports is the number of fits at a time too.
  FitService(session::Models& models, const session::Limits& limits, AccessGuard& guard);

  // Adds the methods to the table. The service outlives it.
  void AddTo(CallTable& calls);

  // On Lane::kWork, for seconds. RESOURCE_EXHAUSTED above limits.exports at a time, or above a caller's share, and for
  // a scene larger than allowed; the errors of fit::ReadFitRequest, fit::MakeSceneLungs and fit::FitMotion.
  grpc::Status FitMotion(grpc::CallbackServerContext* context, const v1::FitMotionRequest* request,
                         ReplyStream<v1::FitMotionResponse>* writer);
  // The same, of many people.
  grpc::Status StudyMotion(grpc::CallbackServerContext* context, const v1::StudyMotionRequest* request,
                           ReplyStream<v1::StudyMotionResponse>* writer);

 private:
  // Returns the lungs of the scene, for a call of this caller.
  absl::StatusOr<fit::SceneLungs> LungsOf(const v1::SceneSource& source, const access::Caller& caller,
                                          grpc::CallbackServerContext& context);

  session::Models& models_;
  AccessGuard& guard_;
  const double longest_;  // of making the lungs [s]
  FairShare fits_;        // that run
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_FIT_SERVICE_H_
