// Steps a session to a given tick and measures the cost. Used by `phrenic run`, `phrenic replay` and campaigns on an
// in-process server.
#ifndef PHRENIC_CLIENT_CONNECTION_LOCAL_RUN_H_
#define PHRENIC_CLIENT_CONNECTION_LOCAL_RUN_H_

#include <functional>
#include <string>

#include "client/connection/context.h"
#include "client/connection/measure_ranges.h"
#include "phrenic/v1/session.grpc.pb.h"
#include "server/service/server_options.h"

namespace phrenic::client {

// How often measures are read for the ranges that runs report [1/s of simulated time].
inline constexpr double kReadingsPerSecond = 60;

// The cost and the results of a run.
struct RunCost {
  std::int64_t steps = 0;
  double simulated = 0, wall = 0, cpu = 0;  // [s]; wall and CPU time of stepping only
  std::string state_hash;                   // after the last step
  MeasureRanges measures;
  double residual = 0;                // largest violation of a constraint that was seen [m]
  std::vector<std::string> warnings;  // of the session, the last of each constraint
};

// Returns the options of an in-process server. Compiling has no time limit; the user can interrupt it.
service::ServerOptions LocalOptions(const std::string& data_dir);

// Returns the first tick at which a session that starts at t = 0 has simulated `seconds` [s].
std::int64_t TickAt(double seconds, const v1::Session& session);

// Steps the session until tick `last` or until it diverges, and adds to `cost`. Each call steps 1/40 of the run, or
// 1/60 simulated second if the scene has measures. `session` holds the session's state before the call, and after it.
// `progress` receives the tick after each call. Returns the first error of the server.
grpc::Status StepUntil(const Context& context, std::int64_t last, v1::SessionService::Stub& stub, v1::Session* session,
                       RunCost* cost, const std::function<void(std::int64_t)>& progress);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_CONNECTION_LOCAL_RUN_H_
