// One session stepped to its end over an in-process channel, and what that took: `phrenic run`, `phrenic replay` and
// campaigns.
#ifndef PHRENIC_CLIENT_CONNECTION_LOCAL_RUN_H_
#define PHRENIC_CLIENT_CONNECTION_LOCAL_RUN_H_

#include <functional>
#include <string>

#include "client/connection/connection.h"
#include "client/print/readings.h"
#include "phrenic/v1/session.grpc.pb.h"

namespace phrenic::client {

// What a run took.
struct Cost {
  std::int64_t steps = 0;
  double simulated = 0, wall = 0, cpu = 0;  // [s]; of the stepping
  std::string state_hash;
  Readings readings;
};

// The tick at which a session that begins at rest has simulated `seconds` [s].
std::int64_t TickAt(double seconds, const v1::Session& session);

// Steps the session until tick `last` or until it diverges, in portions of about a fortieth, or of a frame where the
// scene has measures to be read. `session` is its state before, and then after; `progress` is told the tick.
grpc::Status StepThrough(const Context& context, std::int64_t last, v1::SessionService::Stub& stub,
                         v1::Session* session, Cost* cost, const std::function<void(std::int64_t)>& progress);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CONNECTION_LOCAL_RUN_H_
