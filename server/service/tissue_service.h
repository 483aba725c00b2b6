// v1.TissueService: the interior of the lungs of a running session.
#ifndef PHRENIC_SERVER_SERVICE_TISSUE_SERVICE_H_
#define PHRENIC_SERVER_SERVICE_TISSUE_SERVICE_H_

#include <map>
#include <memory>
#include <optional>

#include "absl/base/thread_annotations.h"
#include "absl/status/statusor.h"
#include "absl/synchronization/mutex.h"
#include "phrenic/v1/tissue.pb.h"
#include "server/physiology/live_lungs.h"
#include "server/service/calls/access_guard.h"
#include "server/service/calls/call_table.h"
#include "server/session/limits.h"
#include "server/session/table.h"

namespace phrenic::service {

// Thread-safe: the methods run on threads of their lanes. The lungs of a model are made by the first call that needs
// them, kept until neither a session nor the cache of models has the model, and shared by its sessions. Errors as in
// the proto of each method.
class TissueService final {
 public:
  // Table and guard outlive the service. limits.compile_seconds bounds the making of lungs too.
  TissueService(session::Table& table, AccessGuard& guard, const session::Limits& limits);

  // Adds the methods to the table. The service outlives it.
  void AddTo(CallTable& calls);

  // Drops the lungs of models that exist no longer. The server calls it every few seconds.
  void DropUnused() ABSL_LOCKS_EXCLUDED(mutex_);

  // On Lane::kWork: the first call for a model computes for a second or two.
  grpc::Status GetTissue(grpc::CallbackServerContext* context, const v1::GetTissueRequest* request,
                         ReplyStream<v1::GetTissueResponse>* writer);
  // On Lane::kWork too, since it makes the lungs if no call has. Reads the state that viewers see.
  grpc::Status ReadTissue(grpc::CallbackServerContext* context, const v1::ReadTissueRequest* request,
                          v1::ReadTissueResponse* response);

 private:
  using Lungs = absl::StatusOr<std::shared_ptr<const physiology::LiveLungs>>;
  // The lungs of one model. One call makes them, and the others wait for it.
  struct Made {
    std::weak_ptr<const Model> model;
    absl::Mutex mutex;
    bool making ABSL_GUARDED_BY(mutex) = false;
    // Unset before, and after a call that was cancelled. An error stays, so that it is computed once.
    std::optional<Lungs> lungs ABSL_GUARDED_BY(mutex);
  };

  // Returns the entry of a model. Drops those whose model no session has.
  std::shared_ptr<Made> EntryOf(const std::shared_ptr<const Model>& model) ABSL_LOCKS_EXCLUDED(mutex_);
  // The errors of LiveLungs::Make, CANCELLED when the client disconnects.
  Lungs LungsOf(const std::shared_ptr<const Model>& model, grpc::CallbackServerContext& context);

  session::Table& table_;
  AccessGuard& guard_;
  const double longest_;  // of making lungs [s]
  absl::Mutex mutex_;
  std::map<const Model*, std::shared_ptr<Made>> made_ ABSL_GUARDED_BY(mutex_);
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_TISSUE_SERVICE_H_
