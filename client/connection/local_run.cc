#include "client/connection/local_run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>

#include "client/connection/connection.h"

namespace phrenic::client {
namespace {

double ProcessCpuSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

std::int64_t FortiethOf(std::int64_t total) {
  return std::min<std::int64_t>(1'000'000, std::max<std::int64_t>(1, total / 40));
}

// Keeps the last warning of each constraint, since the amounts differ.
void NoteWarnings(const v1::Session& session, RunCost& cost) {
  for (const std::string& warning : session.warnings()) {
    const std::string what = warning.substr(0, warning.find(','));
    const auto same = [&what](const std::string& other) { return other.starts_with(what); };
    std::erase_if(cost.warnings, same);
    cost.warnings.push_back(warning);
  }
}

}  // namespace

service::ServerOptions LocalOptions(const std::string& data_dir) {
  service::ServerOptions options;
  options.data_dir = data_dir;
  options.limits.compile_seconds = 0;
  return options;
}

std::int64_t TickAt(double seconds, const v1::Session& session) {
  return static_cast<std::int64_t>(std::ceil(seconds / session.parameters().time_step() - 1e-9));
}

grpc::Status StepUntil(const Context& context, std::int64_t last, v1::SessionService::Stub& stub, v1::Session* session,
                       RunCost* cost, const std::function<void(std::int64_t)>& progress) {
  const std::int64_t frame =
      std::max<std::int64_t>(1, std::lround(1 / (kReadingsPerSecond * session->parameters().time_step())));
  std::int64_t ticks = std::min(frame, FortiethOf(last));
  const auto start = std::chrono::steady_clock::now();
  const double cpu = ProcessCpuSeconds();
  while (session->tick() < last && session->state() != v1::SESSION_STATE_DIVERGED) {
    v1::StepSessionRequest request;
    request.set_session_id(session->id());
    request.set_ticks(std::min(ticks, last - session->tick()));
    v1::StepSessionResponse response;
    grpc::Status status = Call(context, stub, &v1::SessionService::Stub::StepSession, request, &response, 3600);
    if (!status.ok()) return status;
    *session = response.session();
    cost->state_hash = response.state_hash();
    cost->measures.Add(response.measures());
    cost->residual = std::max(cost->residual, session->constraint_residual());
    NoteWarnings(*session, *cost);
    if (response.measures().empty()) ticks = FortiethOf(last);
    progress(session->tick());
  }
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  cost->steps = session->tick(), cost->simulated = session->time();
  cost->wall = wall.count(), cost->cpu = ProcessCpuSeconds() - cpu;
  return grpc::Status::OK;
}

}  // namespace phrenic::client
