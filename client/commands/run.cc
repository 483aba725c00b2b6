// `phrenic run`: the server's own services in this process, over an in-process channel; one way to run a session.
#include <iostream>
#include <nlohmann/json.hpp>

#include "absl/strings/str_format.h"
#include "client/cli/scene_argument.h"
#include "client/commands/commands.h"
#include "client/connection/local_run.h"
#include "client/files/motion_file.h"
#include "client/print/print_session.h"
#include "client/print/table.h"
#include "client/terminal/progress.h"
#include "phrenic/v1/session.grpc.pb.h"
#include "server/service/server.h"
#include "server/session/export/export_catalogue.h"
#include "server/study/thesis_tables.h"

namespace phrenic::client {
namespace {

using Pulls = google::protobuf::RepeatedPtrField<v1::Pull>;

grpc::Status CreateHere(const Context& context, const RunOptions& options, const v1::SceneSource& source,
                        const v1::Parameters& parameters, const Pulls& pulls, v1::SessionService::Stub& stub,
                        v1::GetSessionResponse* session) {
  v1::CreateSessionRequest request;
  *request.mutable_source() = source;
  *request.mutable_parameters() = parameters;
  request.set_session_id("run");
  request.set_preset(options.preset);
  for (const v1::Pull& pull : pulls) *request.add_pulls() = pull;
  v1::CreateSessionResponse created;
  const Progress compiling("compiling " + options.scene.scene);
  grpc::Status status = Call(context, stub, &v1::SessionService::Stub::CreateSession, request, &created);
  if (!status.ok()) return status;
  v1::GetSessionRequest get;
  get.set_session_id("run");
  return Call(context, stub, &v1::SessionService::Stub::GetSession, get, session);
}

int ExportHere(const Context& context, const RunOptions& options, service::Server& server, Cost* cost) {
  MotionOptions motion = options.motion;
  const auto format = record::FindFormat(session::ExportFormats(), FormatOf(motion.file));
  if (!format.ok()) return Fail(format.status());
  // A surface is that of the run's end, unless a time is said; a motion is the whole run.
  if (format->instant && !motion.start) motion.start = options.seconds;
  if (!format->instant) motion.seconds = options.seconds - motion.start.value_or(0);
  const auto request = MakeExportRequest("run", motion);
  if (!request.ok()) return Fail(request.status());
  v1::ExportSummary summary;
  const int code = ExportToFile(context, server.InProcessChannel(), *request, motion.file, &summary);
  *cost = {summary.steps(),
           summary.simulated_seconds(),
           summary.step_wall_seconds(),
           summary.step_cpu_seconds(),
           summary.state_hash(),
           {}};
  return code;
}

void PrintCost(const RunOptions& options, const v1::CompileReport& report, const Cost& cost,
               const study::ThesisFigure& thesis) {
  const double rate = static_cast<double>(cost.steps) / cost.wall;
  std::cout << absl::StrFormat("%s: %d vertices, %d springs, %d rigid links, %d attachments\n", report.scene(),
                               report.simulated_vertices(), report.springs(), report.rigid_links(),
                               report.attachments());
  std::cout << absl::StrFormat("%.3f s simulated in %d steps: %.3f s wall, %.3f s CPU\n", cost.simulated, cost.steps,
                               cost.wall, cost.cpu);
  Table table({"", "steps/s", "x real time", "us CPU a step", "ns CPU a spring and step"});
  const double step_cpu = cost.cpu / static_cast<double>(cost.steps);
  table.Add(
      {"Phrenic", absl::StrFormat("%.0f", rate), absl::StrFormat("%.2f", cost.simulated / cost.wall),
       absl::StrFormat("%.1f", 1e6 * step_cpu),
       report.springs() > 0 ? absl::StrFormat("%.2f", 1e9 * step_cpu / static_cast<double>(report.springs())) : "-"});
  table.Add({"thesis (" + thesis.what + ")", absl::StrFormat("%.2f", thesis.steps_per_second), "-", "-", "-"});
  table.Print(std::cout);
  std::cout << absl::StrFormat("%.0f times the thesis' steps a second (another machine, 2008)\nstate hash %s\n",
                               rate / thesis.steps_per_second, cost.state_hash);
  cost.readings.Print(std::cout);
  if (!options.motion.file.empty()) std::cout << "wrote " << options.motion.file << "\n";
}

void PrintCostJson(const RunOptions& options, const v1::GetSessionResponse& session, const Cost& cost,
                   const study::ThesisFigure& thesis) {
  nlohmann::json json = {
      {"simulated_seconds", cost.simulated},
      {"steps", cost.steps},
      {"wall_seconds", cost.wall},
      {"cpu_seconds", cost.cpu},
      {"steps_per_second", static_cast<double>(cost.steps) / cost.wall},
      {"times_real_time", cost.simulated / cost.wall},
      {"thesis", {{"figure", thesis.what}, {"steps_per_second", thesis.steps_per_second}}},
      {"state_hash", cost.state_hash},
      {"measures", cost.readings.ToJson()},
      {"file", options.motion.file},
      {"report", nlohmann::json::parse(Json(session.report()))},
      {"session", nlohmann::json::parse(Json(session.session()))},
  };
  std::cout << json.dump(1) << "\n";
}

// What a run would do, once its scene is compiled.
int Predict(const Context& context, const RunOptions& options, const v1::GetSessionResponse& session) {
  const double step = session.session().parameters().time_step();
  const auto steps = static_cast<std::int64_t>(std::ceil(options.seconds / step - 1e-9));
  if (context.json()) {
    const nlohmann::json json = {{"steps", steps},
                                 {"time_step", step},
                                 {"file", options.motion.file},
                                 {"report", nlohmann::json::parse(Json(session.report()))},
                                 {"session", nlohmann::json::parse(Json(session.session()))}};
    std::cout << json.dump(1) << "\n";
    return kOk;
  }
  std::cout << absl::StrFormat("%s: %d vertices, %d springs, %d rigid links\nwould take %d steps of %.4g ms\n",
                               session.report().scene(), session.report().simulated_vertices(),
                               session.report().springs(), session.report().rigid_links(), steps, 1e3 * step);
  if (!options.motion.file.empty()) std::cout << "would write " << options.motion.file << "\n";
  return kOk;
}

int RunOn(const Context& context, const RunOptions& options, const v1::SceneSource& source,
          const v1::Parameters& parameters, const Pulls& pulls, service::Server& server) {
  const auto stub = v1::SessionService::NewStub(server.InProcessChannel());
  v1::GetSessionResponse session;
  grpc::Status status = CreateHere(context, options, source, parameters, pulls, *stub, &session);
  if (!status.ok()) return Fail(context, status);
  // The scene as the server has it; its model is kept, so that this compiles nothing anew.
  v1::DescribeSceneRequest describe;
  *describe.mutable_source() = source;
  v1::DescribeSceneResponse described;
  const auto scenes = v1::SceneService::NewStub(server.InProcessChannel());
  status = Call(context, *scenes, &v1::SceneService::Stub::DescribeScene, describe, &described);
  if (!status.ok()) return Fail(context, status);
  if (options.dry) return Predict(context, options, session);
  Cost cost;
  if (!options.motion.file.empty()) {
    const int code = ExportHere(context, options, server, &cost);
    if (code != kOk) return code;
  } else {
    {
      const std::int64_t last = TickAt(options.seconds, session.session());
      Progress progress("stepping", static_cast<double>(last));
      status = StepThrough(context, last, *stub, session.mutable_session(), &cost,
                           [&](std::int64_t tick) { progress.Update(static_cast<double>(tick)); });
    }
    if (!status.ok()) return Fail(context, status);
  }
  const study::ThesisFigure thesis = study::NearestThesisFigure(described.scene(), session.report());
  if (context.json()) {
    PrintCostJson(options, session, cost, thesis);
  } else {
    PrintCost(options, session.report(), cost, thesis);
    // An export steps a copy of the session: what this one keeps is not its end.
    if (options.motion.file.empty()) {
      std::cout << SolverText(session.session(), "solver: ", "\n")
                << ResidualText(session.session(), "constraints kept within ", "\n");
    }
  }
  if (session.session().state() != v1::SESSION_STATE_DIVERGED) return kOk;
  PrintSession(session.session(), std::cerr);
  return kFailed;
}

}  // namespace

int Run(const Context& context, const RunOptions& options) {
  const absl::StatusOr<v1::SceneSource> source = ReadSceneArgument(options.scene.scene, options.scene.resolution_mm);
  if (!source.ok()) return Fail(source.status());
  const absl::StatusOr<v1::Parameters> parameters = ReadSettings(options.settings);
  if (!parameters.ok()) return Fail(parameters.status());
  const auto pulls = ReadPulls(options.pulls);
  if (!pulls.ok()) return Fail(pulls.status());
  service::ServerOptions server_options;
  server_options.data_dir = options.data_dir;
  server_options.step_threads = options.threads;
  if (!options.spool_dir.empty()) server_options.spool_dir = options.spool_dir;
  auto server = service::Server::Start(server_options);
  if (!server.ok()) return Fail(server.status());
  return RunOn(context, options, *source, *parameters, *pulls, **server);
}

}  // namespace phrenic::client
