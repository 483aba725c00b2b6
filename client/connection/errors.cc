#include "client/connection/errors.h"

#include <unistd.h>

#include <iostream>
#include <utility>

#include "client/connection/reachable.h"
#include "client/terminal/terminal.h"

namespace phrenic::client {
namespace {

// Prints the command that lists what was not found.
void PrintListCommand(const std::string& error) {
  constexpr std::pair<const char*, const char*> kListCommands[] = {
      {"session_id:", "phrenic sessions; or create one: phrenic create thorax --play"},
      {"export_id:", "phrenic exports list"},
      {"study_id:", "phrenic study list"}};
  for (const auto& [field, command] : kListCommands) {
    if (error.starts_with(field)) std::cerr << "  list them: " << command << "\n";
  }
}

// gRPC reports UNAVAILABLE both for a missing server and for a server that answers that it is not available now.
int FailUnavailable(const Context& context, const std::string& message) {
  if (IsReachable(HostOf(context))) {
    std::cerr << ErrorPrefix() << " the server at " << context.server << " is not available now: " << message
              << "\n  try again; to find the cause: phrenic doctor\n";
  } else {
    std::cerr << ErrorPrefix() << " no server at " << context.server << " (" << message
              << "): start one with deploy/run or phrenicd, or name another with --server HOST:PORT\n"
              << "  to find the cause: phrenic doctor\n";
  }
  return kUnreachable;
}

int ExitCodeOf(grpc::StatusCode code) { return code == grpc::StatusCode::INVALID_ARGUMENT ? kUsage : kFailed; }

}  // namespace

std::string ErrorPrefix() { return Painted("phrenic:", Ink::kRed, STDERR_FILENO); }

int Fail(const Context& context, const grpc::Status& status) {
  if (context.interruption != nullptr && context.interruption->happened()) {
    std::cerr << ErrorPrefix() << " interrupted\n";
    return kInterrupted;
  }
  if (status.error_code() == grpc::StatusCode::UNAVAILABLE) return FailUnavailable(context, status.error_message());
  std::cerr << ErrorPrefix() << " " << status.error_message() << "\n";
  if (status.error_code() == grpc::StatusCode::NOT_FOUND) PrintListCommand(status.error_message());
  const bool refused = status.error_code() == grpc::StatusCode::PERMISSION_DENIED ||
                       status.error_code() == grpc::StatusCode::UNAUTHENTICATED;
  return refused ? kNotAllowed : ExitCodeOf(status.error_code());
}

int Fail(const absl::Status& status) {
  std::cerr << ErrorPrefix() << " " << std::string(status.message()) << "\n";
  return ExitCodeOf(static_cast<grpc::StatusCode>(status.code()));  // equal numbers
}

}  // namespace phrenic::client
