// `phrenic compare`: how far two surfaces or motions are apart, by the server's own study.
#include <algorithm>
#include <climits>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "absl/strings/strip.h"
#include "client/commands/commands.h"
#include "client/files/motion_file.h"
#include "client/files/whole_file.h"
#include "client/print/comparison.h"
#include "client/print/junit.h"
#include "client/terminal/progress.h"
#include "phrenic/v1/compare.grpc.pb.h"
#include "server/service/server.h"

namespace phrenic::client {
namespace {

constexpr absl::string_view kSessionPrefix = "session:";
constexpr std::uintmax_t kMostBytes = std::uintmax_t{1000} << 20;  // two such files fit one message

// "session:ID", "session:ID/BODY".
bool IsSession(const std::string& words) { return absl::StartsWith(words, kSessionPrefix); }

void NameBody(const std::string& words, v1::SessionBody& body) {
  const std::vector<std::string> parts =
      absl::StrSplit(absl::StripPrefix(words, kSessionPrefix), absl::MaxSplits('/', 1));
  body.set_session_id(parts[0]);
  if (parts.size() > 1) body.set_body(parts[1]);
}

absl::Status ReadSurface(const std::string& path, v1::ComparedSurface& file) {
  std::error_code error;
  if (std::filesystem::is_regular_file(path, error) && std::filesystem::file_size(path, error) > kMostBytes) {
    return absl::InvalidArgumentError(
        absl::StrCat(path, ":1: larger than 1000 MiB, the most that is compared; record fewer frames a second"));
  }
  std::ifstream in(path, std::ios::binary);
  std::ostringstream bytes;
  if (!std::filesystem::is_regular_file(path, error) || !in ||
      (!(bytes << in.rdbuf()) && in.peek() != std::ifstream::traits_type::eof())) {
    return absl::NotFoundError(absl::StrCat("cannot read \"", path, "\": is there such a file, and may it be read?"));
  }
  file.set_name(path);
  file.set_content(std::move(bytes).str());
  return absl::OkStatus();
}

absl::Status NameSurface(const std::string& words, double unit_mm, std::optional<double> time,
                         v1::ComparedSurface& surface) {
  if (unit_mm > 0) surface.set_unit_mm(unit_mm);
  if (time) surface.set_time(*time);
  if (!IsSession(words)) return ReadSurface(words, surface);
  NameBody(words, *surface.mutable_body());
  return absl::OkStatus();
}

absl::StatusOr<v1::CompareRequest> MakeRequest(const CompareOptions& options) {
  v1::CompareRequest request;
  absl::Status status_a = NameSurface(options.a, options.unit_a_mm, options.time_a, *request.mutable_a());
  if (!status_a.ok()) return status_a;
  absl::Status status_b = NameSurface(options.b, options.unit_b_mm, options.time_b, *request.mutable_b());
  if (!status_b.ok()) return status_b;
  if (options.tolerance_mm > 0) request.set_tolerance_mm(options.tolerance_mm);
  if (options.spacing_mm > 0) request.set_spacing_mm(options.spacing_mm);
  request.set_by_region(options.by_region);
  request.set_match_phases(options.match_phases);
  if (options.map_file.empty()) return request;
  request.set_map_format(FormatOf(options.map_file));
  if (!request.map_format().empty()) return request;
  return absl::InvalidArgumentError(
      absl::StrCat("--map ", options.map_file, ": the name's ending tells the format; name it .msh or .vtp"));
}

void Print(const Context& context, const v1::ComparisonTable& table) {
  if (context.json()) {
    std::cout << Json(table) << "\n";
  } else if (context.output == Output::kCsv) {
    PrintComparisonCsv(table, std::cout);
  } else {
    PrintComparison(table, std::cout);
  }
}

int JudgeLimits(const CompareOptions& options, const v1::ComparisonTable& table, const std::vector<Limit>& limits) {
  std::vector<JudgedCase> cases;
  for (const Limit& limit : limits) {
    const std::vector<std::string> missed = MissedLimits(table, {limit});
    cases.push_back({limit.measure->name(), missed.empty() ? "" : missed.front()});
    for (const std::string& sentence : missed) std::cerr << "phrenic: " << sentence << "\n";
  }
  if (!options.junit_file.empty()) {
    const absl::Status written = WriteJUnit(options.junit_file, options.a + " and " + options.b, cases);
    if (!written.ok()) return Fail(written);
  }
  const auto failed = [](const JudgedCase& judged) { return !judged.failure.empty(); };
  return std::any_of(cases.begin(), cases.end(), failed) ? kMissed : kOk;
}

int CompareOn(const Context& context, const CompareOptions& options, const v1::CompareRequest& request,
              const std::vector<Limit>& limits, const std::shared_ptr<grpc::Channel>& channel) {
  grpc::ClientContext call;
  const Interruption::Scope scope(*context.interruption, call);
  const auto stub = v1::CompareService::NewStub(channel);
  const auto reader = stub->Compare(&call, request);
  v1::CompareResponse response;
  std::string map;
  {
    Progress progress("comparing", 1);
    while (reader->Read(&response) && !response.has_table()) {
      if (response.has_map_chunk()) map += response.map_chunk();
      if (response.has_progress()) progress.Update(response.progress());
    }
  }
  if (const grpc::Status status = reader->Finish(); !status.ok()) {
    const int code = Fail(context, status);
    const bool of_files = !IsSession(options.a) && !IsSession(options.b);
    if (context.server_given && of_files && status.error_code() == grpc::StatusCode::RESOURCE_EXHAUSTED) {
      std::cerr << "phrenic: without --server the comparison is made here, of files of up to 1000 MiB\n";
    }
    return code;
  }
  if (!options.map_file.empty()) {
    if (const absl::Status status = WriteWhole(options.map_file, map); !status.ok()) return Fail(status);
  }
  Print(context, response.table());
  return JudgeLimits(options, response.table(), limits);
}

}  // namespace

int Compare(const Context& context, const CompareOptions& options) {
  const auto limits = ReadLimits(options.checks);
  if (!limits.ok()) {
    Fail(limits.status());
    return kUsage;
  }
  const auto request = MakeRequest(options);
  if (!request.ok()) return Fail(request.status());
  if (context.server_given || IsSession(options.a) || IsSession(options.b)) {
    return CompareOn(context, options, *request, *limits, Connect(context));
  }
  service::ServerOptions server_options;
  server_options.max_message_bytes = INT_MAX;
  auto server = service::Server::Start(server_options);
  if (!server.ok()) return Fail(server.status());
  return CompareOn(context, options, *request, *limits, (*server)->InProcessChannel());
}

}  // namespace phrenic::client
