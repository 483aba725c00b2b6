// `phrenic run`: simulates a scene with the server's own services in this process, over an in-process channel.
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/strip.h"
#include "client/cli/argument_kinds.h"
#include "client/cli/shared_options.h"
#include "client/commands/commands.h"
#include "client/connection/connection.h"
#include "client/connection/errors.h"
#include "client/connection/local_run.h"
#include "client/files/motion_file.h"
#include "client/print/output.h"
#include "client/print/print_session.h"
#include "client/print/readings.h"
#include "client/print/table.h"
#include "client/terminal/progress.h"
#include "phrenic/v1/session.grpc.pb.h"
#include "server/service/server.h"
#include "server/session/export/export_catalogue.h"
#include "server/study/thesis_tables.h"

namespace phrenic::client {
namespace {

struct RunOptions {
  SceneOptions scene;
  double seconds = 8;  // simulated time [s]
  std::string preset;
  std::vector<std::string> settings;
  std::vector<std::string> pulls;
  MotionOptions motion;             // no export if its file is empty
  std::string data_dir, spool_dir;  // empty spool_dir: the server's default
  int threads = 1;
  bool dry_run = false;
  std::string check;  // "residual_mm=0.001"; empty: none
};

// The run's options, parsed.
struct RunInput {
  v1::SceneSource source;
  v1::Parameters parameters;
  google::protobuf::RepeatedPtrField<v1::Pull> pulls;
  double most_residual_mm = HUGE_VAL;
};

// Returns the limit of `--check residual_mm=LIMIT` [mm]; infinity without the flag.
absl::StatusOr<double> ReadCheck(const std::string& text) {
  if (text.empty()) return HUGE_VAL;
  absl::string_view number = text;
  double limit = 0;
  if (!absl::ConsumePrefix(&number, "residual_mm=") || !absl::SimpleAtod(number, &limit) || !(limit >= 0)) {
    return absl::InvalidArgumentError(
        absl::StrCat("--check ", text, ": write residual_mm=LIMIT, such as residual_mm=0.001"));
  }
  return limit;
}

absl::StatusOr<RunInput> ReadRunInput(const RunOptions& options) {
  const absl::StatusOr<v1::SceneSource> source = ReadScene(options.scene);
  if (!source.ok()) return source.status();
  const absl::StatusOr<v1::Parameters> parameters = ReadSettings(options.settings);
  if (!parameters.ok()) return parameters.status();
  const auto pulls = ReadPulls(options.pulls);
  if (!pulls.ok()) return pulls.status();
  const absl::StatusOr<double> residual = ReadCheck(options.check);
  if (!residual.ok()) return residual.status();
  return RunInput{*source, *parameters, *pulls, *residual};
}

grpc::Status CreateRunSession(const Context& context, const RunOptions& options, const RunInput& input,
                              v1::SessionService::Stub& stub, v1::GetSessionResponse* session) {
  v1::CreateSessionRequest request;
  *request.mutable_source() = input.source;
  *request.mutable_parameters() = input.parameters;
  request.set_session_id("run");
  request.set_preset(options.preset);
  *request.mutable_pulls() = input.pulls;
  v1::CreateSessionResponse created;
  const Progress compiling("compiling " + options.scene.scene);
  grpc::Status status = Call(context, stub, &v1::SessionService::Stub::CreateSession, request, &created);
  if (!status.ok()) return status;
  v1::GetSessionRequest get;
  get.set_session_id("run");
  return Call(context, stub, &v1::SessionService::Stub::GetSession, get, session);
}

// Sets the times that the options leave open: a surface is exported at the end of the run, a motion over the whole run,
// and a page plays the last whole breath, or the second one of a run that is too short for two.
void ChooseTimes(const RunOptions& options, const record::Format& format, double breath_length, MotionOptions& motion) {
  if (format.page) {
    const double breaths = std::floor(options.seconds / breath_length + 1e-9);
    if (!motion.start && breaths >= 2) motion.start = (breaths - 1) * breath_length;
    return;
  }
  if (format.instant && !motion.start) motion.start = options.seconds;
  if (!format.instant) motion.seconds = options.seconds - motion.start.value_or(0);
}

// Sets `session` to the state at the end.
int ExportRun(const Context& context, const RunOptions& options, service::Server& server, v1::Session* session,
              RunCost* cost) {
  MotionOptions motion = options.motion;
  const auto format = record::FindFormat(session::ExportFormats(), FormatOf(motion.file));
  if (!format.ok()) return Fail(format.status());
  ChooseTimes(options, *format, session->parameters().breath_length(), motion);
  const auto request = MakeExportRequest("run", motion);
  if (!request.ok()) return Fail(request.status());
  v1::ExportSummary summary;
  const int code = ExportToFile(context, server.InProcessChannel(), *request, motion.file, &summary);
  *cost = {summary.steps(),
           summary.simulated_seconds(),
           summary.step_wall_seconds(),
           summary.step_cpu_seconds(),
           summary.state_hash(),
           {},
           summary.constraint_residual(),
           {summary.warnings().begin(), summary.warnings().end()}};
  session->set_time(summary.end_time());
  session->set_tick(summary.end_tick());
  session->clear_constraint_residual();
  if (summary.has_constraint_residual()) session->set_constraint_residual(summary.constraint_residual());
  session->set_residual_constraint(summary.residual_constraint());
  *session->mutable_warnings() = summary.warnings();
  return code;
}

void PrintCost(const RunOptions& options, const v1::CompileReport& report, const RunCost& cost,
               const std::optional<study::ThesisFigure>& thesis) {
  const double rate = static_cast<double>(cost.steps) / cost.wall;
  std::cout << absl::StrFormat("%s: %d vertices, %d springs, %d rigid links, %d attachments; compiled in %.3f s\n",
                               report.scene(), report.simulated_vertices(), report.springs(), report.rigid_links(),
                               report.attachments(), report.compile_seconds());
  std::cout << absl::StrFormat("%.3f s simulated in %d steps: %.3f s wall, %.3f s CPU\n", cost.simulated, cost.steps,
                               cost.wall, cost.cpu);
  Table table({"", "steps/s", "x real time", "us CPU per step", "ns CPU per spring and step"});
  const double step_cpu = cost.cpu / static_cast<double>(cost.steps);
  table.Add(
      {"Phrenic", absl::StrFormat("%.0f", rate), absl::StrFormat("%.2f", cost.simulated / cost.wall),
       absl::StrFormat("%.1f", 1e6 * step_cpu),
       report.springs() > 0 ? absl::StrFormat("%.2f", 1e9 * step_cpu / static_cast<double>(report.springs())) : "-"});
  if (thesis) {
    table.Add({"thesis (" + thesis->what + ")", absl::StrFormat("%.2f", thesis->steps_per_second), "-", "-", "-"});
  }
  table.Print(std::cout);
  if (thesis) {
    std::cout << absl::StrFormat("%.0f times the steps per second of the thesis (another machine, 2008)\n",
                                 rate / thesis->steps_per_second);
  }
  std::cout << "state hash " << cost.state_hash << "\n";
  PrintMeasureRanges(cost.measures, std::cout);
  if (!options.motion.file.empty()) std::cout << "wrote " << options.motion.file << "\n";
}

void PrintCostJson(const RunOptions& options, const v1::GetSessionResponse& session, const RunCost& cost,
                   const std::optional<study::ThesisFigure>& thesis) {
  nlohmann::json json = {
      {"simulated_seconds", cost.simulated},
      {"steps", cost.steps},
      {"wall_seconds", cost.wall},
      {"cpu_seconds", cost.cpu},
      {"steps_per_second", static_cast<double>(cost.steps) / cost.wall},
      {"times_real_time", cost.simulated / cost.wall},
      {"state_hash", cost.state_hash},
      {"measures", MeasureRangesJson(cost.measures)},
      {"constraint_residual_mm", 1e3 * cost.residual},
      {"warnings", cost.warnings},
      {"file", options.motion.file},
      {"report", nlohmann::json::parse(Json(session.report()))},
      {"session", nlohmann::json::parse(Json(session.session()))},
  };
  if (thesis) json["thesis"] = {{"figure", thesis->what}, {"steps_per_second", thesis->steps_per_second}};
  PrintJson(json);
}

// Returns the thesis' figure of a model like the scene's; nullopt if the thesis has none.
std::optional<study::ThesisFigure> ThesisFigureOf(const v1::Scene& scene, const v1::CompileReport& report) {
  const auto trial = report.rigid_links() > 0 ? study::ThesisTrial::kFull : study::ThesisTrial::kNoLinks;
  return study::LikeThesisFigure(scene, report.simulated_vertices(), trial);
}

// Prints what the run would do, after its scene was compiled.
int PrintPlan(const Context& context, const RunOptions& options, const v1::GetSessionResponse& session) {
  const double step = session.session().parameters().time_step();
  const auto steps = static_cast<std::int64_t>(std::ceil(options.seconds / step - 1e-9));
  if (context.json()) {
    const nlohmann::json json = {{"steps", steps},
                                 {"time_step", step},
                                 {"file", options.motion.file},
                                 {"report", nlohmann::json::parse(Json(session.report()))},
                                 {"session", nlohmann::json::parse(Json(session.session()))}};
    PrintJson(json);
    return kOk;
  }
  std::cout << absl::StrFormat("%s: %d vertices, %d springs, %d rigid links\nwould take %d steps of %.4g ms\n",
                               session.report().scene(), session.report().simulated_vertices(),
                               session.report().springs(), session.report().rigid_links(), steps, 1e3 * step);
  if (!options.motion.file.empty()) std::cout << "would write " << options.motion.file << "\n";
  return kOk;
}

int RunOn(const Context& context, const RunOptions& options, const RunInput& input, service::Server& server) {
  const auto stub = v1::SessionService::NewStub(server.InProcessChannel());
  v1::GetSessionResponse session;
  grpc::Status status = CreateRunSession(context, options, input, *stub, &session);
  if (!status.ok()) return Fail(context, status);
  // The server keeps the compiled model, so that this call compiles nothing.
  v1::DescribeSceneRequest describe;
  *describe.mutable_source() = input.source;
  v1::DescribeSceneResponse described;
  const auto scenes = v1::SceneService::NewStub(server.InProcessChannel());
  status = Call(context, *scenes, &v1::SceneService::Stub::DescribeScene, describe, &described);
  if (!status.ok()) return Fail(context, status);
  if (options.dry_run) return PrintPlan(context, options, session);
  RunCost cost;
  if (!options.motion.file.empty()) {
    const int code = ExportRun(context, options, server, session.mutable_session(), &cost);
    if (code != kOk) return code;
  } else {
    {
      const std::int64_t last = TickAt(options.seconds, session.session());
      Progress progress("stepping", static_cast<double>(last));
      status = StepUntil(context, last, *stub, session.mutable_session(), &cost,
                         [&](std::int64_t tick) { progress.Update(static_cast<double>(tick)); });
    }
    if (!status.ok()) return Fail(context, status);
  }
  const std::optional<study::ThesisFigure> thesis = ThesisFigureOf(described.scene(), session.report());
  if (context.json()) {
    PrintCostJson(options, session, cost, thesis);
  } else {
    PrintCost(options, session.report(), cost, thesis);
    std::cout << SolverText(session.session(), "solver: ", "\n")
              << ResidualText(session.session(), "constraints kept within ", "\n");
  }
  for (const std::string& warning : cost.warnings) std::cerr << "phrenic: warning: " << warning << "\n";
  if (session.session().state() == v1::SESSION_STATE_DIVERGED) {
    PrintSession(session.session(), std::cerr);
    return kFailed;
  }
  if (1e3 * cost.residual <= input.most_residual_mm) return kOk;
  std::cerr << absl::StrFormat("phrenic: residual_mm is %.4g; the limit is at most %g\n", 1e3 * cost.residual,
                               input.most_residual_mm);
  return kMissed;
}

int Run(const Context& context, const RunOptions& options) {
  const absl::StatusOr<RunInput> input = ReadRunInput(options);
  if (!input.ok()) return Fail(input.status());
  service::ServerOptions server_options = LocalOptions(options.data_dir);
  server_options.step_threads = options.threads;
  if (!options.spool_dir.empty()) server_options.spool_dir = options.spool_dir;
  auto server = service::Server::Start(server_options);
  if (!server.ok()) return Fail(server.status());
  return RunOn(context, options, *input, **server);
}

}  // namespace

CommandFunction SetUpRun(CLI::App& command) {
  const auto options = std::make_shared<RunOptions>();
  AddScene(command, options->scene);
  AddPreset(command, options->preset);
  AddParameters(command, options->settings);
  AddPulls(command, options->pulls);
  command.add_option("--seconds", options->seconds, "simulated time [s]")
      ->check(NumberIn(1e-6, 3600.0))
      ->capture_default_str();
  command.add_option("--export", options->motion.file, "write the motion to this file" + ExportEndings())
      ->check(ExportFile());
  AddMotion(command, options->motion);
  command.add_option("--threads", options->threads, "threads for a step of a large scene; does not change the result")
      ->check(NumberIn(1, 256))
      ->capture_default_str();
  command.add_option(
      "--check", options->check,
      "limit of the largest violation of a rigid link or length limit, residual_mm=LIMIT; exit code 4 if "
      "it is exceeded");
  command.add_option("--spool", options->spool_dir, "folder for the temporary data of an export");
  AddDataFolder(command, options->data_dir);
  command.add_flag("--dry-run", options->dry_run, "compile the scene and print what the run would do");
  return Bind(&Run, options);
}

}  // namespace phrenic::client
