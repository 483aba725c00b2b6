// v1.CompareService: compares surfaces and motions.
#ifndef PHRENIC_SERVER_SERVICE_COMPARE_SERVICE_H_
#define PHRENIC_SERVER_SERVICE_COMPARE_SERVICE_H_

#include "phrenic/v1/compare.pb.h"
#include "server/schema/part_of.h"
#include "server/service/calls/access_guard.h"
#include "server/service/calls/call_table.h"
#include "server/service/calls/fair_share.h"
#include "server/session/limits.h"
#include "server/session/table.h"

namespace phrenic::service {

// Thread-safe: the method runs on a thread of its lane until the comparison is done or its caller disconnects.
// RESOURCE_EXHAUSTED above limits.exports at a time, or above a caller's share of them. A comparison reads the sessions
// once, between two steps, and copies what it needs; steps go on meanwhile.
class CompareService final {
 public:
  // Table and guard outlive the service. limits.exports is the number of comparisons too.
  CompareService(const session::Table& table, const session::Limits& limits, AccessGuard& guard)
      : table_(table),
        guard_(guard),
        comparisons_(
            {"comparisons", "--max-exports, --max-share", limits.exports, PartOf(limits.exports, limits.share)}) {}

  // Adds the methods to the table. The service outlives it.
  void AddTo(CallTable& calls);

  // On Lane::kWork. Writes the mesh of B, then progress, distances and map, and last the table; after an error there is
  // no table. A session that the caller may not see is NOT_FOUND. CANCELLED if the client disconnects, which the
  // comparison notices when it next reports progress. Other errors are those of compare::Compare.
  grpc::Status Compare(grpc::CallbackServerContext* context, const v1::CompareRequest* request,
                       ReplyStream<v1::CompareResponse>* writer);

 private:
  const session::Table& table_;
  AccessGuard& guard_;     // also decides which sessions the caller may name
  FairShare comparisons_;  // that run
};

}  // namespace phrenic::service

#endif  // PHRENIC_SERVER_SERVICE_COMPARE_SERVICE_H_
