// v1::ReferenceService: ranges of health and static curves, for graphs.
#ifndef PHRENIC_SERVER_SERVICE_REFERENCE_SERVICE_H_
#define PHRENIC_SERVER_SERVICE_REFERENCE_SERVICE_H_

#include "phrenic/v1/references.pb.h"
#include "server/service/calls/access_guard.h"
#include "server/service/calls/call_table.h"
#include "server/session/table.h"

namespace phrenic::service {

// Thread-safe: the method runs on a thread of its lane. Errors as in the proto of the method.
class ReferenceService final {
 public:
  // Table and guard outlive the service.
  ReferenceService(const session::Table& table, AccessGuard& guard) : table_(table), guard_(guard) {}

  // Adds the method to the table. The service outlives it.
  void AddTo(CallTable& calls) { calls.Add(Lane::kQuick, *this, &ReferenceService::GetReferences); }

  // On Lane::kQuick: computes for a few milliseconds, and waits for no step.
  grpc::Status GetReferences(grpc::CallbackServerContext* context, const v1::GetReferencesRequest* request,
                             v1::GetReferencesResponse* response);

 private:
  const session::Table& table_;
  AccessGuard& guard_;
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_REFERENCE_SERVICE_H_
