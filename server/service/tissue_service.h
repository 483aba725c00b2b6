// v1.TissueService: the interior of the lungs of a running session.
#ifndef PHRENIC_SERVER_SERVICE_TISSUE_SERVICE_H_
#define PHRENIC_SERVER_SERVICE_TISSUE_SERVICE_H_

#include <map>
#include <memory>

#include "absl/base/thread_annotations.h"
#include "absl/synchronization/mutex.h"
#include "phrenic/v1/tissue.pb.h"
#include "server/physiology/live_lungs.h"
#include "server/service/calls/access_guard.h"
#include "server/service/calls/call_table.h"
#include "server/session/limits.h"
#include "server/session/table.h"

namespace phrenic::service {

// Thread-safe: the methods run on threads of their lanes. The lungs of a model are made by the first call that needs
// them, kept while a session has the model, and shared by all sessions of it. Errors as in the proto of each method.
class TissueService final {
 public:
  // Table and guard outlive the service. limits.compile_seconds bounds the making of lungs too.
  TissueService(session::Table& table, AccessGuard& guard, const session::Limits& limits);

  // Adds the methods to the table. The service outlives it.
  void AddTo(CallTable& calls);

  // On Lane::kWork: the first call for a model computes for a second or two.
  grpc::Status GetTissue(grpc::CallbackServerContext* context, const v1::GetTissueRequest* request,
                         ReplyStream<v1::GetTissueResponse>* writer);
  // On Lane::kSession. Reads the state that viewers see, and computes on the lane's thread.
  grpc::Status ReadTissue(grpc::CallbackServerContext* context, const v1::ReadTissueRequest* request,
                          v1::ReadTissueResponse* response);

 private:
  // The lungs of one model; `mutex` is held while they are made, so that two callers do not both make them.
  struct Made {
    std::weak_ptr<const Model> model;
    absl::Mutex mutex;
    std::shared_ptr<const physiology::LiveLungs> lungs ABSL_GUARDED_BY(mutex);  // null before
  };

  // Returns the entry of a model. Drops those whose model no session has.
  std::shared_ptr<Made> EntryOf(const std::shared_ptr<const Model>& model) ABSL_LOCKS_EXCLUDED(mutex_);
  // The errors of LiveLungs::Make, CANCELLED when the client disconnects.
  absl::StatusOr<std::shared_ptr<const physiology::LiveLungs>> LungsOf(const std::shared_ptr<const Model>& model,
                                                                       grpc::CallbackServerContext& context);

  session::Table& table_;
  AccessGuard& guard_;
  const double longest_;  // of making lungs [s]
  absl::Mutex mutex_;
  std::map<const Model*, std::shared_ptr<Made>> made_ ABSL_GUARDED_BY(mutex_);
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_TISSUE_SERVICE_H_
