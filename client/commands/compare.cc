// `phrenic compare`: measures the distance between two surfaces or motions, in this process or on a server.
#include <algorithm>
#include <climits>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <optional>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "absl/strings/strip.h"
#include "client/cli/argument_kinds.h"
#include "client/cli/schema_options.h"
#include "client/cli/shared_options.h"
#include "client/commands/commands.h"
#include "client/connection/connection.h"
#include "client/connection/errors.h"
#include "client/connection/local_run.h"
#include "client/files/junit.h"
#include "client/files/motion_file.h"
#include "client/files/whole_file.h"
#include "client/print/comparison.h"
#include "client/print/output.h"
#include "client/terminal/progress.h"
#include "phrenic/v1/compare.grpc.pb.h"
#include "server/meshio/meshio.h"
#include "server/record/distance_map.h"
#include "server/service/server.h"

namespace phrenic::client {
namespace {

constexpr absl::string_view kSessionPrefix = "session:";
constexpr std::uintmax_t kMostBytes = std::uintmax_t{1000} << 20;  // two such files fit into one message

struct CompareOptions {
  std::string a, b;                      // files, or "session:ID/BODY"
  std::optional<double> time_a, time_b;  // [s]
  double unit_a_mm = 0, unit_b_mm = 0;   // length of the files' units [mm]; 0: the schema's default, here and below
  double tolerance_mm = 0;
  double spacing_mm = 0;
  bool by_region = false;
  bool match_phases = false;
  std::string map_file;  // empty: none
  std::vector<std::string> checks;
  std::string junit_file;  // empty: none
};

// True for "session:ID" and "session:ID/BODY".
bool IsSession(const std::string& text) { return absl::StartsWith(text, kSessionPrefix); }

void NameBody(const std::string& text, v1::SessionBody& body) {
  const std::vector<std::string> parts =
      absl::StrSplit(absl::StripPrefix(text, kSessionPrefix), absl::MaxSplits('/', 1));
  body.set_session_id(parts[0]);
  if (parts.size() > 1) body.set_body(parts[1]);
}

absl::Status ReadComparedFile(const std::string& path, v1::ComparedSurface& file) {
  std::error_code error;
  if (std::filesystem::is_regular_file(path, error) && std::filesystem::file_size(path, error) > kMostBytes) {
    return absl::InvalidArgumentError(
        absl::StrCat(path, ":1: larger than 1000 MiB, the limit for a comparison; record fewer frames per second"));
  }
  absl::StatusOr<std::string> bytes = ReadWhole(path, "the surface");
  if (!bytes.ok()) return bytes.status();
  file.set_name(path);
  file.set_content(*std::move(bytes));
  return absl::OkStatus();
}

absl::Status SetSurface(const std::string& text, double unit_mm, std::optional<double> time,
                        v1::ComparedSurface& surface) {
  if (unit_mm > 0) surface.set_unit_mm(unit_mm);
  if (time) surface.set_time(*time);
  if (!IsSession(text)) return ReadComparedFile(text, surface);
  NameBody(text, *surface.mutable_body());
  return absl::OkStatus();
}

absl::StatusOr<v1::CompareRequest> MakeCompareRequest(const CompareOptions& options) {
  v1::CompareRequest request;
  absl::Status status_a = SetSurface(options.a, options.unit_a_mm, options.time_a, *request.mutable_a());
  if (!status_a.ok()) return status_a;
  absl::Status status_b = SetSurface(options.b, options.unit_b_mm, options.time_b, *request.mutable_b());
  if (!status_b.ok()) return status_b;
  if (options.tolerance_mm > 0) request.set_tolerance_mm(options.tolerance_mm);
  if (options.spacing_mm > 0) request.set_spacing_mm(options.spacing_mm);
  request.set_by_region(options.by_region);
  request.set_match_phases(options.match_phases);
  if (options.map_file.empty()) return request;
  request.set_map_format(FormatOf(options.map_file));
  if (!request.map_format().empty()) return request;
  return absl::InvalidArgumentError(
      absl::StrCat("--map ", options.map_file, ": unknown format; use a name ending in .msh or .vtp"));
}

void PrintTable(const Context& context, const v1::ComparisonTable& table) {
  if (context.json()) {
    std::cout << Json(table) << "\n";
  } else if (context.output == Output::kCsv) {
    PrintComparisonCsv(table, std::cout);
  } else {
    PrintComparison(table, std::cout);
  }
}

// Checks the limits and writes the JUnit file. Returns the exit code.
int CheckComparison(const CompareOptions& options, const v1::ComparisonTable& table, const std::vector<Limit>& limits) {
  std::vector<CheckResult> checks;
  for (const Limit& limit : limits) {
    const std::vector<std::string> missed = MissedLimits(table, {limit});
    checks.push_back({limit.measure->name(), missed.empty() ? "" : missed.front()});
    for (const std::string& sentence : missed) std::cerr << "phrenic: " << sentence << "\n";
  }
  if (!options.junit_file.empty()) {
    const absl::Status written = WriteJUnit(options.junit_file, options.a + " and " + options.b, checks);
    if (!written.ok()) return Fail(written);
  }
  const auto failed = [](const CheckResult& check) { return !check.failure.empty(); };
  return std::any_of(checks.begin(), checks.end(), failed) ? kMissed : kOk;
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
      std::cerr << "phrenic: without --server this program compares files of up to 1000 MiB\n";
    }
    return code;
  }
  if (!options.map_file.empty()) {
    if (const absl::Status status = WriteWhole(options.map_file, map); !status.ok()) return Fail(status);
  }
  PrintTable(context, response.table());
  for (const std::string& warning : response.table().warnings()) std::cerr << "phrenic: warning: " << warning << "\n";
  return CheckComparison(options, response.table(), limits);
}

int Compare(const Context& context, const CompareOptions& options) {
  const auto limits = ReadLimits(options.checks);
  if (!limits.ok()) {
    return Fail(limits.status());
  }
  const auto request = MakeCompareRequest(options);
  if (!request.ok()) return Fail(request.status());
  if (context.server_given || IsSession(options.a) || IsSession(options.b)) {
    return CompareOn(context, options, *request, *limits, Connect(context));
  }
  service::ServerOptions server_options = LocalOptions("");
  server_options.max_message_bytes = INT_MAX;
  auto server = service::Server::Start(server_options);
  if (!server.ok()) return Fail(server.status());
  return CompareOn(context, options, *request, *limits, (*server)->InProcessChannel());
}

}  // namespace

CommandFunction SetUpCompare(CLI::App& command) {
  const auto options = std::make_shared<CompareOptions>();
  const google::protobuf::Descriptor& request = *v1::CompareRequest::descriptor();
  const google::protobuf::Descriptor& surface = *v1::ComparedSurface::descriptor();
  command
      .add_option("A", options->a,
                  "surface (" + meshio::Endings() +
                      "), motion written by `phrenic run --export` (.msh), or the present state of a session's body: "
                      "session:ID or session:ID/BODY")
      ->required();
  command.add_option("B", options->b, "like A; motions are interpolated to the times of A")->required();
  AddNumber(command, "--tolerance", options->tolerance_mm, request, "tolerance_mm");
  AddNumber(command, "--spacing", options->spacing_mm, request, "spacing_mm");
  AddNumber(command, "--unit-a", options->unit_a_mm, surface, "unit_mm");
  AddNumber(command, "--unit-b", options->unit_b_mm, surface, "unit_mm");
  AddNumber(command, "--time-a", options->time_a, surface, "time");
  AddNumber(command, "--time-b", options->time_b, surface, "time");
  command.add_flag("--regions", options->by_region, "also compare each region (body) with that of the same name");
  command.add_flag("--phases", options->match_phases,
                   "scale the times of B so that they start and end with those of A");
  command.add_option("--map", options->map_file, "write A coloured by its distance to B (.msh: Gmsh; .vtp: ParaView)")
      ->check(ParsedBy([](const std::string& file) { return record::FindMapFormat(FormatOf(file)).status(); }));
  command.add_option("--check", options->checks, "limits of measures, comma-separated; exit code 4 if one is exceeded")
      ->delimiter(',')
      ->allow_extra_args(false);
  AddJUnit(command, options->junit_file);
  command.footer("\n" + MeasureHelp());
  return Bind(&Compare, options);
}

}  // namespace phrenic::client
