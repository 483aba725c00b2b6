#include <memory>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "client/campaign/worker.h"
#include "client/connection/connection.h"
#include "client/connection/local_run.h"
#include "server/service/server.h"

namespace phrenic::client {
namespace {

constexpr char kCell[] = "cell";

void WriteCost(const RunCost& cost, bool constrained, const std::string& cell, v1::CampaignResult& result) {
  v1::CampaignRow& row = *result.mutable_rows(0);
  row.set_simulated_seconds(cost.simulated);
  row.set_steps(cost.steps);
  if (cost.steps > 0) row.set_cpu_us_a_step(1e6 * cost.cpu / static_cast<double>(cost.steps));
  if (cost.wall > 0) row.set_times_real_time(cost.simulated / cost.wall);
  row.set_state_hash(cost.state_hash);
  if (constrained) row.set_constraint_residual_mm(1e3 * cost.residual);
  for (const MeasureRange& range : cost.measures.ranges()) {
    v1::CampaignReading& reading = *result.add_readings();
    reading.set_cell(cell);
    reading.set_measure(range.name);
    reading.set_unit(range.unit);
    reading.set_last(range.last);
    reading.set_least(range.minimum);
    reading.set_greatest(range.maximum);
  }
}

grpc::Status RunSession(const Context& context, const CampaignCell& cell, v1::SessionService::Stub& stub,
                        v1::CampaignResult& result) {
  v1::CreateSessionRequest create;
  *create.mutable_source() = cell.source;
  *create.mutable_parameters() = cell.parameters;
  create.set_preset(cell.row.preset());
  create.set_session_id(kCell);
  v1::CreateSessionResponse created;
  grpc::Status status = Call(context, stub, &v1::SessionService::Stub::CreateSession, create, &created);
  if (!status.ok()) return status;
  RunCost cost;
  v1::Session& session = *created.mutable_session();
  status = StepUntil(context, TickAt(cell.seconds, session), stub, &session, &cost, [](std::int64_t) {});
  if (status.ok()) WriteCost(cost, session.has_constraint_residual(), cell.row.cell(), result);
  v1::CampaignRow& row = *result.mutable_rows(0);
  row.set_outcome(session.has_divergence() ? "diverged" : "done");
  if (session.has_divergence()) {
    const v1::Divergence& why = session.divergence();
    row.set_why(absl::StrCat("at t = ", why.time(), " s, vertex ", why.vertex(), " of ", why.body(), ", by ",
                             why.force(), "; ", why.remedy()));
  }
  v1::DeleteSessionRequest remove;
  remove.set_session_id(kCell);
  v1::DeleteSessionResponse removed;
  const grpc::Status deleted = Call(context, stub, &v1::SessionService::Stub::DeleteSession, remove, &removed);
  return status.ok() ? deleted : status;
}

// True if the error concerns this run only, so that the share continues.
bool ConcernsRunOnly(const grpc::Status& status) {
  return status.error_code() == grpc::StatusCode::INVALID_ARGUMENT ||
         status.error_code() == grpc::StatusCode::NOT_FOUND ||
         status.error_code() == grpc::StatusCode::FAILED_PRECONDITION ||
         status.error_code() == grpc::StatusCode::RESOURCE_EXHAUSTED;
}

absl::Status RunCell(const Context& context, const CampaignCell& cell, v1::SessionService::Stub& stub,
                     const CampaignFolder& folder) {
  v1::CampaignResult result;
  *result.add_rows() = cell.row;
  const grpc::Status status = RunSession(context, cell, stub, result);
  if (context.interruption->happened()) return absl::CancelledError("interrupted");
  if (!status.ok() && !ConcernsRunOnly(status)) return absl::InternalError(status.error_message());
  if (!status.ok()) {
    result.mutable_rows(0)->set_outcome("failed");
    result.mutable_rows(0)->set_why(status.error_message());
  }
  return folder.Write(result);
}

}  // namespace

absl::StatusOr<Share> ReadShare(const std::string& text) {
  Share share;
  const size_t slash = text.find('/');
  if (slash != std::string::npos && absl::SimpleAtoi(text.substr(0, slash), &share.number) &&
      absl::SimpleAtoi(text.substr(slash + 1), &share.count) && share.number >= 0 && share.number < share.count) {
    return share;
  }
  return absl::InvalidArgumentError(
      absl::StrCat("--share \"", text, "\" is not of the form 3/16, between 0/16 and 15/16"));
}

absl::Status Work(const Context& context, const std::vector<CampaignCell>& cells, const Share& share,
                  const std::string& data_dir, const CampaignFolder& folder) {
  const auto server = service::Server::Start(LocalOptions(data_dir));
  if (!server.ok()) return server.status();
  const auto stub = v1::SessionService::NewStub((*server)->InProcessChannel());
  for (auto i = static_cast<size_t>(share.number); i < cells.size(); i += static_cast<size_t>(share.count)) {
    if (folder.Has(cells[i])) continue;
    if (absl::Status status = RunCell(context, cells[i], *stub, folder); !status.ok()) return status;
  }
  return absl::OkStatus();
}

}  // namespace phrenic::client
