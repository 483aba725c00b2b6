// `phrenic study`: studies of a scene, in this process or on a server, and the list of a server's studies.
#include <iostream>

#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "client/cli/schema_options.h"
#include "client/cli/shared_options.h"
#include "client/cli/study_inputs.h"
#include "client/commands/commands.h"
#include "client/connection/connection.h"
#include "client/connection/errors.h"
#include "client/connection/local_run.h"
#include "client/connection/wait_for_study.h"
#include "client/files/junit.h"
#include "client/files/study_limits.h"
#include "client/files/whole_file.h"
#include "client/print/output.h"
#include "client/print/rows.h"
#include "phrenic/v1/study.grpc.pb.h"
#include "server/service/server.h"

namespace phrenic::client {
namespace {

// What to do with a study's result.
struct ResultOptions {
  std::string page, limits, junit_file;  // empty: none
};

struct StudyOptions {
  SceneOptions scene;
  std::vector<std::string> settings;
  v1::CreateStudyRequest request;  // kind, its options, preset and id; the rest comes from the other options
  std::string data_dir;
  bool detach = false;  // true: run on the server and do not wait
  ResultOptions result;
};

struct WatchStudyOptions {
  std::string id;
  ResultOptions result;
};

const google::protobuf::Message& ResultTables(const v1::StudyResult& result) {
  switch (result.result_case()) {
    case v1::StudyResult::kStability:
      return result.stability();
    case v1::StudyResult::kCost:
      return result.cost();
    case v1::StudyResult::kStreaming:
      return result.streaming();
    case v1::StudyResult::kSensitivity:
      return result.sensitivity();
    case v1::StudyResult::kUncertainty:
      return result.uncertainty();
    case v1::StudyResult::kConvergence:
      return result.convergence();
    default:
      return result.error();
  }
}

std::string StudyStateName(v1::StudyState state) {
  switch (state) {
    case v1::STUDY_STATE_QUEUED:
      return "queued";
    case v1::STUDY_STATE_RUNNING:
      return "running";
    case v1::STUDY_STATE_DONE:
      return "done";
    case v1::STUDY_STATE_FAILED:
      return "failed";
    default:
      return "unknown";
  }
}

void PrintReference(const v1::Reference& reference) {
  std::cout << absl::StrFormat(
      "reference: %s, tolerance %g m; its own error is %.2g mm (maximum), %.2g mm (RMS over the vertices that move "
      "freely); %d evaluations, %.3g s CPU\n"
      "largest displacement: %.4g mm\n",
      reference.method(), reference.tolerance_m(), reference.error_max_mm(), reference.error_rms_mm(),
      reference.evaluations(), reference.cpu_s(), reference.largest_displacement_mm());
}

void PrintStreaming(const v1::StreamingTable& table) {
  std::cout << absl::StrFormat("\n%s\n%d vertices, %d frames; the shapes of codec \"basis\" take %d bytes, sent once\n",
                               table.advice(), table.vertices(), table.frames(), table.basis_bytes());
}

// Says how many runs a table is of, and how many failed.
template <typename RunsTable>
void PrintRuns(const RunsTable& table) {
  std::cout << absl::StrFormat("\n%d runs", table.runs());
  if (table.failed() > 0) std::cout << absl::StrFormat("; %d FAILED: %s", table.failed(), table.problem());
  std::cout << "\n";
}

void PrintStudy(const v1::StudyResult& result) {
  std::cout << absl::StrFormat("%s (scene %.12s), %.1f s\n", result.scene(), result.scene_hash(), result.took_s());
  if (result.has_error()) PrintReference(result.error().reference());
  PrintTables(ResultTables(result), std::cout);
  if (result.has_error()) std::cout << "\n" << result.error().advice() << "\n";
  if (result.has_streaming()) PrintStreaming(result.streaming());
  if (result.has_sensitivity()) {
    PrintRuns(result.sensitivity());
    std::cout << result.sensitivity().advice() << "\n";
  }
  if (result.has_uncertainty()) PrintRuns(result.uncertainty());
  if (result.has_convergence()) PrintRuns(result.convergence());
  for (const std::string& note : result.cost().notes()) std::cout << "\nnote: " << note << "\n";
  if (result.cost().has_growth_exponent()) {
    std::cout << absl::StrFormat("\ncost grows with vertices^%.3f\n", result.cost().growth_exponent());
  }
}

int WriteStudyPage(const Context& context, v1::StudyService::Stub& stub, const std::string& id,
                   const std::string& file) {
  v1::GetStudyPageRequest request;
  request.set_study_id(id);
  v1::GetStudyPageResponse response;
  const grpc::Status status = Call(context, stub, &v1::StudyService::Stub::GetStudyPage, request, &response);
  if (!status.ok()) return Fail(context, status);
  if (const absl::Status written = WriteWhole(file, response.html()); !written.ok()) return Fail(written);
  std::cerr << "wrote " << file << "\n";
  return kOk;
}

// Checks the limits and writes the JUnit file. Returns the exit code.
int CheckLimits(const ResultOptions& options, const v1::StudyResult& result) {
  const auto limits = ReadStudyLimits(options.limits);
  if (!limits.ok()) return Fail(limits.status());
  std::vector<CheckResult> checks;
  int met = 0;
  for (const v1::StudyLimit& limit : limits->limits()) {
    v1::StudyLimits one;
    *one.add_limits() = limit;
    const auto exceeded = ExceededLimits(one, ResultTables(result));
    if (!exceeded.ok()) return Fail(exceeded.status());
    for (const std::string& sentence : *exceeded) std::cerr << "phrenic: limit exceeded: " << sentence << "\n";
    checks.push_back({LimitText(limit), absl::StrJoin(*exceeded, "; ")});
    met += exceeded->empty() ? 1 : 0;
  }
  std::cerr << absl::StrFormat("%d of %d limits met\n", met, limits->limits_size());
  if (!options.junit_file.empty()) {
    const absl::Status written = WriteJUnit(options.junit_file, "study of " + result.scene(), checks);
    if (!written.ok()) return Fail(written);
  }
  return met == limits->limits_size() ? kOk : kMissed;
}

// Waits for the study and prints its result. Returns the exit code.
int FinishStudy(const Context& context, const ResultOptions& options, v1::StudyService::Stub& stub,
                const std::string& id) {
  v1::Study study;
  const grpc::Status status = WaitForStudy(context, stub, id, &study);
  if (!status.ok()) return Fail(context, status);
  if (study.state() == v1::STUDY_STATE_FAILED) return Fail(absl::AbortedError(study.problem()));
  if (context.output == Output::kJson) {
    std::cout << Json(study.result()) << "\n";
  } else if (context.output == Output::kCsv) {
    PrintCsv(ResultTables(study.result()), std::cout);
  } else {
    PrintStudy(study.result());
  }
  if (!options.page.empty()) {
    if (const int code = WriteStudyPage(context, stub, id, options.page); code != kOk) return code;
  }
  return options.limits.empty() ? kOk : CheckLimits(options, study.result());
}

int CreateStudy(const Context& context, const StudyOptions& options, v1::StudyService::Stub& stub) {
  const auto source = ReadScene(options.scene);
  if (!source.ok()) return Fail(source.status());
  const auto parameters = ReadSettings(options.settings);
  if (!parameters.ok()) return Fail(parameters.status());
  v1::CreateStudyRequest request = options.request;
  *request.mutable_source() = *source;
  *request.mutable_parameters() = *parameters;
  v1::CreateStudyResponse response;
  const grpc::Status status = Call(context, stub, &v1::StudyService::Stub::CreateStudy, request, &response);
  if (!status.ok()) return Fail(context, status);
  const std::string& id = response.study().id();
  if (!options.detach) return FinishStudy(context, options.result, stub, id);
  std::cout << (context.json() ? Json(response.study()) : id) << "\n";
  if (!context.json())
    std::cerr << "the study continues on the server; to see its result: phrenic study watch " << id << "\n";
  return kOk;
}

int Study(const Context& context, const StudyOptions& options) {
  if (!options.result.limits.empty()) {
    if (const auto limits = ReadStudyLimits(options.result.limits); !limits.ok()) return Fail(limits.status());
  }
  if (context.server_given || options.detach)
    return CreateStudy(context, options, *v1::StudyService::NewStub(Connect(context)));
  service::ServerOptions server_options = LocalOptions(options.data_dir);
  auto server = service::Server::Start(server_options);
  if (!server.ok()) return Fail(server.status());
  return CreateStudy(context, options, *v1::StudyService::NewStub((*server)->InProcessChannel()));
}

int WatchStudy(const Context& context, const WatchStudyOptions& options) {
  return FinishStudy(context, options.result, *v1::StudyService::NewStub(Connect(context)), options.id);
}

int DeleteStudy(const Context& context, const std::string& id) {
  v1::DeleteStudyRequest request;
  request.set_study_id(id);
  v1::DeleteStudyResponse response;
  const auto stub = v1::StudyService::NewStub(Connect(context));
  const grpc::Status status = Call(context, *stub, &v1::StudyService::Stub::DeleteStudy, request, &response);
  return status.ok() ? kOk : Fail(context, status);
}

int ListStudies(const Context& context) {
  v1::ListStudiesResponse response;
  const auto stub = v1::StudyService::NewStub(Connect(context));
  const grpc::Status status =
      Call(context, *stub, &v1::StudyService::Stub::ListStudies, v1::ListStudiesRequest(), &response);
  if (!status.ok()) return Fail(context, status);
  Table table({"study", "scene", "state", "done", "doing"});
  for (const v1::Study& study : response.studies()) {
    table.Add({study.id(), study.scene(), StudyStateName(study.state()),
               absl::StrFormat("%.0f %%", 100 * study.progress()),
               study.state() == v1::STUDY_STATE_FAILED ? study.problem() : study.doing()});
  }
  PrintList(context, response, table);
  return kOk;
}

void AddResult(CLI::App& command, ResultOptions& options) {
  command.add_option("--page", options.page, "write tables and plots to this .html file");
  command.add_option("--check", options.limits, "limits (.textproto, StudyLimits); exit code 4 if one is exceeded");
  AddJUnit(command, options.junit_file);
}

// Adds the options of a study of one kind; `kind` is its message in options->request.
CommandFunction SetUpStudy(CLI::App& command, const std::shared_ptr<StudyOptions>& options,
                           google::protobuf::Message* kind) {
  AddScene(command, options->scene);
  AddPreset(command, *options->request.mutable_preset());
  AddParameters(command, options->settings);
  AddSchemaOptions(command, kind);
  AddResult(command, options->result);
  AddDataFolder(command, options->data_dir);
  command.add_option("--id", *options->request.mutable_study_id(), "name of the study: 1 to 64 of a-z, 0-9 and -");
  command.add_flag("--detach", options->detach, "run on the server and do not wait (with --server alone: wait)");
  return Bind(&Study, options);
}

}  // namespace

CommandFunction SetUpStudyError(CLI::App& command) {
  const auto options = std::make_shared<StudyOptions>();
  return SetUpStudy(command, options, options->request.mutable_error());
}

CommandFunction SetUpStudyStability(CLI::App& command) {
  const auto options = std::make_shared<StudyOptions>();
  return SetUpStudy(command, options, options->request.mutable_stability());
}

CommandFunction SetUpStudyCost(CLI::App& command) {
  const auto options = std::make_shared<StudyOptions>();
  return SetUpStudy(command, options, options->request.mutable_cost());
}

CommandFunction SetUpStudyStreaming(CLI::App& command) {
  const auto options = std::make_shared<StudyOptions>();
  return SetUpStudy(command, options, options->request.mutable_streaming());
}

CommandFunction SetUpStudySensitivity(CLI::App& command) {
  const auto options = std::make_shared<StudyOptions>();
  v1::SensitivityStudy* study = options->request.mutable_sensitivity();
  AddInputs(command, study->mutable_inputs());
  AddOutputs(command, study->mutable_outputs());
  return SetUpStudy(command, options, study);
}

CommandFunction SetUpStudyUncertainty(CLI::App& command) {
  const auto options = std::make_shared<StudyOptions>();
  v1::UncertaintyStudy* study = options->request.mutable_uncertainty();
  AddInputs(command, study->mutable_inputs());
  AddOutputs(command, study->mutable_outputs());
  return SetUpStudy(command, options, study);
}

CommandFunction SetUpStudyConvergence(CLI::App& command) {
  const auto options = std::make_shared<StudyOptions>();
  v1::ConvergenceStudy* study = options->request.mutable_convergence();
  AddOutputs(command, study->mutable_outputs());
  return SetUpStudy(command, options, study);
}

CommandFunction SetUpStudyList(CLI::App&) { return ListStudies; }

CommandFunction SetUpStudyWatch(CLI::App& command) {
  const auto options = std::make_shared<WatchStudyOptions>();
  command.add_option("STUDY", options->id)->required();
  AddResult(command, options->result);
  return Bind(&WatchStudy, options);
}

CommandFunction SetUpStudyDelete(CLI::App& command) {
  const auto id = std::make_shared<std::string>();
  command.add_option("STUDY", *id)->required();
  return Bind(&DeleteStudy, id);
}

}  // namespace phrenic::client
