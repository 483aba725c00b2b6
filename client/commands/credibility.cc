// `phrenic credibility`: a report of a model's credibility for one context of use, with the server's own services in
// this process.
#include <google/protobuf/util/json_util.h>
#include <sys/utsname.h>

#include <chrono>
#include <iostream>
#include <map>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/time/time.h"
#include "client/cli/argument_kinds.h"
#include "client/cli/shared_options.h"
#include "client/cli/shell_word.h"
#include "client/commands/commands.h"
#include "client/connection/connection.h"
#include "client/connection/errors.h"
#include "client/connection/local_run.h"
#include "client/connection/wait_for_study.h"
#include "client/credibility/command_text.h"
#include "client/credibility/context_file.h"
#include "client/credibility/report.h"
#include "client/files/junit.h"
#include "client/files/whole_file.h"
#include "client/print/output.h"
#include "client/print/table.h"
#include "client/terminal/progress.h"
#include "phrenic/v1/session.grpc.pb.h"
#include "server/crypto/sha256.h"
#include "server/schema/fields.h"
#include "server/service/server.h"
#include "server/service/study_page.h"

namespace phrenic::client {
namespace {

struct CredibilityOptions {
  SceneOptions scene;
  std::string use, data_dir, page, junit_file;                                   // empty page, junit_file: none
  std::string sensitivity, uncertainty, convergence, physiology, orders, exact;  // files of evidence; empty: none
  std::vector<std::string> evidence;                                             // "NAME=FILE"
  double budget = 3600;                                                          // [s]; no study begins later
  bool check = false;
};

// Makes the evidence that a context requires, or reads it from files.
class EvidenceMaker {
 public:
  EvidenceMaker(const Context& context, const CredibilityOptions& options, const v1::CredibilityContext& use,
                const v1::SceneSource& source, const std::shared_ptr<grpc::Channel>& channel)
      : context_(context),
        options_(options),
        use_(use),
        source_(source),
        studies_(v1::StudyService::NewStub(channel)),
        scenes_(v1::SceneService::NewStub(channel)),
        began_(std::chrono::steady_clock::now()) {
    scene_text_ = ShellWord(options.scene.scene);
    if (options.scene.resolution_mm > 0) {
      absl::StrAppend(&scene_text_, " --resolution ", schema::FormatNumber(options.scene.resolution_mm));
    }
  }

  // Stops at the first error; status() returns that error.
  absl::Status Make() {
    for (const auto& part : {&EvidenceMaker::Describe, &EvidenceMaker::ReadExact, &EvidenceMaker::RunCases,
                             &EvidenceMaker::RunOrders, &EvidenceMaker::RunConvergence, &EvidenceMaker::RunSensitivity,
                             &EvidenceMaker::RunUncertainty, &EvidenceMaker::RunPhysiology}) {
      if (absl::Status status = (this->*part)(); !status.ok()) return status;
    }
    return absl::OkStatus();
  }

  Evidence evidence;
  EvidenceCommands commands;

 private:
  static absl::Status FromCall(const grpc::Status& status) {
    return absl::Status(static_cast<absl::StatusCode>(status.error_code()), status.error_message());
  }

  absl::Status Describe() {
    v1::DescribeSceneRequest request;
    *request.mutable_source() = source_;
    v1::DescribeSceneResponse response;
    const client::Progress compiling("compiling " + options_.scene.scene);
    const grpc::Status status = Call(context_, *scenes_, &v1::SceneService::Stub::DescribeScene, request, &response);
    if (!status.ok()) return FromCall(status);
    evidence.scene = response.scene().name();
    evidence.scene_hash = response.report().scene_hash();
    return absl::OkStatus();
  }

  // True if the budget is used up; the report then says that `what` was not run.
  bool IsOutOfBudget(const std::string& what) {
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began_;
    if (took.count() < options_.budget) return false;
    evidence.absent.push_back(
        absl::StrFormat("%s was not run: the budget of %g s was used up (--budget).", what, options_.budget));
    return true;
  }

  absl::StatusOr<v1::StudyResult> RunStudy(v1::CreateStudyRequest request, const std::string& name) {
    v1::CreateStudyResponse response;
    request.set_study_id(name);
    const grpc::Status created = Call(context_, *studies_, &v1::StudyService::Stub::CreateStudy, request, &response);
    if (!created.ok()) return FromCall(created);
    v1::Study study;
    const grpc::Status status = WaitForStudy(context_, *studies_, response.study().id(), &study);
    if (!status.ok()) return FromCall(status);
    if (study.state() == v1::STUDY_STATE_FAILED) return absl::AbortedError(absl::StrCat(name, ": ", study.problem()));
    v1::DeleteStudyRequest done;
    done.set_study_id(response.study().id());
    v1::DeleteStudyResponse deleted;
    (void)Call(context_, *studies_, &v1::StudyService::Stub::DeleteStudy, done, &deleted);
    return std::move(*study.mutable_result());
  }

  // Reads the JSON of `phrenic study KIND -o json`.
  absl::StatusOr<v1::StudyResult> ReadStudy(const std::string& file, const std::string& kind,
                                            v1::StudyResult::ResultCase result) {
    const auto text = ReadWhole(file, "the evidence");
    if (!text.ok()) return text.status();
    v1::StudyResult study;
    if (!google::protobuf::util::JsonStringToMessage(*text, &study).ok() || study.result_case() != result) {
      return absl::InvalidArgumentError(
          absl::StrCat(file, " is not the JSON of `phrenic study ", kind, " SCENE -o json`"));
    }
    if (study.scene_hash().empty()) {
      evidence.without_hash.push_back(kind);
    } else if (study.scene_hash() != evidence.scene_hash && kind != "error") {
      evidence.of_other_scenes.push_back(absl::StrFormat("%s (%s), of scene %s", kind, file, study.scene_hash()));
    }
    return study;
  }

  absl::Status ReadExact() {
    commands.exact = "build/exact_test --gtest_output=json:exact.json";
    if (options_.exact.empty()) {
      evidence.absent.push_back(
          "Exact cases were not given: build/exact_test --gtest_output=json:exact.json, then --exact exact.json.");
      return absl::OkStatus();
    }
    const auto text = ReadWhole(options_.exact, "the exact cases");
    if (!text.ok()) return text.status();
    auto cases = ParseExactCases(options_.exact, *text);
    if (!cases.ok()) return cases.status();
    evidence.exact_cases = *std::move(cases);
    return absl::OkStatus();
  }

  // Cases of one preset and the same parameters are read off one run.
  absl::Status RunCases() {
    std::map<std::pair<std::string, std::string>, std::vector<int>> runs;
    for (int i = 0; i < use_.cases_size(); ++i) {
      const v1::CredibilityCase& one = use_.cases(i);
      runs[{one.preset(), one.parameters().SerializeAsString()}].push_back(i);
      v1::NumberRow& row = evidence.numbers.emplace_back();
      row.set_name("case." + one.name());
      row.set_what(one.what());
      row.set_source("one run");
      v1::ConvergenceStudy study;
      study.set_halvings(0);
      *study.add_outputs() = one.output();
      row.set_command(StudyCommand("convergence", scene_text_, one.preset(), one.parameters(), study));
    }
    const size_t first = evidence.numbers.size() - static_cast<size_t>(use_.cases_size());
    for (const auto& [run, cases] : runs) {
      if (absl::Status status = RunCase(cases, first); !status.ok()) return status;
    }
    return absl::OkStatus();
  }

  // Sets the numbers of cases that share a run; `first` is that of the first case.
  absl::Status RunCase(const std::vector<int>& cases, size_t first) {
    const v1::CredibilityCase& one = use_.cases(cases.front());
    if (IsOutOfBudget("case " + one.name())) return absl::OkStatus();
    v1::CreateStudyRequest request = Begin(one.preset());
    *request.mutable_parameters() = one.parameters();
    request.mutable_convergence()->set_halvings(0);
    for (const int i : cases) *request.mutable_convergence()->add_outputs() = use_.cases(i).output();
    const auto result = RunStudy(request, absl::StrCat("case-", cases.front() + 1));
    if (!result.ok()) return result.status();
    for (size_t k = 0; k < cases.size(); ++k) {
      const v1::ConvergenceRow& value = result->convergence().rows(static_cast<int>(k));
      v1::NumberRow& row = evidence.numbers[first + static_cast<size_t>(cases[k])];
      row.set_unit(value.unit());
      if (value.has_value()) row.set_value(value.value());
    }
    return absl::OkStatus();
  }

  v1::CreateStudyRequest Begin(const std::string& preset) const {
    v1::CreateStudyRequest request;
    *request.mutable_source() = source_;
    request.set_preset(preset);
    return request;
  }

  absl::Status RunOrders() {
    if (use_.order_scene().empty() && options_.orders.empty()) return absl::OkStatus();
    commands.orders = absl::StrCat("phrenic study error ", ShellWord(use_.order_scene()));
    if (options_.orders.empty() && IsOutOfBudget("orders")) return absl::OkStatus();
    v1::CreateStudyRequest request;
    request.mutable_source()->set_name(use_.order_scene());
    request.mutable_error();
    const auto result = options_.orders.empty() ? RunStudy(request, "orders")
                                                : ReadStudy(options_.orders, "error", v1::StudyResult::kError);
    if (!result.ok()) return result.status();
    if (result->scene() != use_.order_scene()) {
      evidence.of_other_scenes.push_back(
          absl::StrCat("orders (", options_.orders, "), of ", result->scene(), ", not ", use_.order_scene()));
    }
    evidence.orders = OrdersOf(result->error());
    return absl::OkStatus();
  }

  // Runs or reads one study of the context. Returns its result; no result if it is not wanted or the budget is used up.
  absl::StatusOr<std::optional<v1::StudyResult>> Obtain(const std::string& kind, const std::string& file, bool wanted,
                                                        v1::StudyResult::ResultCase result,
                                                        const v1::CreateStudyRequest& request,
                                                        const google::protobuf::Message& study, std::string& command) {
    command = StudyCommand(kind, scene_text_, use_.preset(), {}, study);
    if (!file.empty()) {
      auto found = ReadStudy(file, kind, result);
      if (!found.ok()) return found.status();
      return std::optional(*std::move(found));
    }
    if (!wanted) {
      evidence.absent.push_back(absl::StrCat("The study of ", kind, " is not in the context."));
      return std::optional<v1::StudyResult>();
    }
    if (IsOutOfBudget("the study of " + kind)) return std::optional<v1::StudyResult>();
    auto made = RunStudy(request, kind);
    if (!made.ok()) return made.status();
    return std::optional(*std::move(made));
  }

  absl::Status RunConvergence() {
    v1::CreateStudyRequest request = Begin(use_.preset());
    *request.mutable_convergence() = use_.convergence();
    const auto found = Obtain("convergence", options_.convergence, use_.has_convergence(),
                              v1::StudyResult::kConvergence, request, request.convergence(), commands.convergence);
    if (!found.ok()) return found.status();
    if (found->has_value()) evidence.convergence = (*found)->convergence();
    return absl::OkStatus();
  }

  absl::Status RunSensitivity() {
    v1::CreateStudyRequest request = Begin(use_.preset());
    *request.mutable_sensitivity() = use_.sensitivity();
    const auto found = Obtain("sensitivity", options_.sensitivity, use_.has_sensitivity(),
                              v1::StudyResult::kSensitivity, request, request.sensitivity(), commands.sensitivity);
    if (!found.ok()) return found.status();
    if (found->has_value()) evidence.sensitivity = (*found)->sensitivity();
    return absl::OkStatus();
  }

  absl::Status RunUncertainty() {
    v1::CreateStudyRequest request = Begin(use_.preset());
    *request.mutable_uncertainty() = use_.uncertainty();
    const auto found = Obtain("uncertainty", options_.uncertainty, use_.has_uncertainty(),
                              v1::StudyResult::kUncertainty, request, request.uncertainty(), commands.uncertainty);
    if (!found.ok()) return found.status();
    if (found->has_value()) evidence.uncertainty = (*found)->uncertainty();
    return absl::OkStatus();
  }

  absl::Status RunPhysiology() {
    commands.physiology = absl::StrCat("phrenic physiology ", scene_text_);
    if (!options_.physiology.empty()) return ReadPhysiology();
    const bool wanted = std::any_of(use_.criteria().begin(), use_.criteria().end(), [](const auto& criterion) {
      return absl::StartsWith(criterion.number(), "physiology.");
    });
    if (!wanted || IsOutOfBudget("physiology")) return absl::OkStatus();
    v1::CheckPhysiologyRequest request;
    *request.mutable_source() = source_;
    grpc::ClientContext call;
    const Interruption::Scope scope(*context_.interruption, call);
    const auto reader = studies_->CheckPhysiology(&call, request);
    v1::CheckPhysiologyResponse response;
    {
      client::Progress progress("physiology", 1);
      while (reader->Read(&response) && !response.has_table()) progress.Update(response.progress());
    }
    if (const grpc::Status status = reader->Finish(); !status.ok()) return FromCall(status);
    evidence.physiology = response.table();
    return absl::OkStatus();
  }

  absl::Status ReadPhysiology() {
    const auto text = ReadWhole(options_.physiology, "the evidence");
    if (!text.ok()) return text.status();
    v1::PhysiologyTable table;
    if (!google::protobuf::util::JsonStringToMessage(*text, &table).ok() || table.rows().empty()) {
      return absl::InvalidArgumentError(
          absl::StrCat(options_.physiology, " is not the JSON of `phrenic physiology SCENE -o json`"));
    }
    if (table.scene() != evidence.scene) {
      evidence.of_other_scenes.push_back(absl::StrCat("physiology (", options_.physiology, "), of ", table.scene()));
    } else {
      evidence.without_hash.push_back(absl::StrCat("physiology (", options_.physiology, ")"));
    }
    evidence.physiology = std::move(table);
    return absl::OkStatus();
  }

  const Context& context_;
  const CredibilityOptions& options_;
  const v1::CredibilityContext& use_;
  const v1::SceneSource& source_;
  const std::unique_ptr<v1::StudyService::Stub> studies_;
  const std::unique_ptr<v1::SceneService::Stub> scenes_;
  const std::chrono::steady_clock::time_point began_;
  std::string scene_text_;
};

void AddVersion(const std::string& of, const std::string& is, Evidence& evidence) {
  v1::VersionRow& row = evidence.versions.emplace_back();
  row.set_of(of);
  row.set_is(is);
}

// Returns the command that was typed, without where its output goes.
std::string CommandOf(const CredibilityOptions& options) {
  std::string line =
      absl::StrCat("phrenic credibility ", ShellWord(options.scene.scene), " --use ", ShellWord(options.use));
  const auto add = [&line](const char* option, const std::string& value) {
    if (!value.empty()) absl::StrAppend(&line, " --", option, " ", ShellWord(value));
  };
  if (options.scene.resolution_mm > 0) add("resolution", schema::FormatNumber(options.scene.resolution_mm));
  add("exact", options.exact);
  add("orders", options.orders);
  add("convergence", options.convergence);
  add("sensitivity", options.sensitivity);
  add("uncertainty", options.uncertainty);
  add("physiology", options.physiology);
  for (const std::string& each : options.evidence) add("evidence", each);
  if (options.budget != CredibilityOptions().budget) add("budget", schema::FormatNumber(options.budget));
  return line;
}

void AddVersions(const CredibilityOptions& options, const std::string& use_text, Evidence& evidence) {
  AddVersion("Phrenic", PHRENIC_VERSION, evidence);
  AddVersion("scene", options.scene.scene, evidence);
  AddVersion("hash of the compiled scene", evidence.scene_hash, evidence);
  AddVersion("context of use", options.use, evidence);
  AddVersion("SHA-256 of the context of use", Sha256Hex(use_text), evidence);
  for (const std::string& file : {options.exact, options.orders, options.convergence, options.sensitivity,
                                  options.uncertainty, options.physiology}) {
    if (file.empty()) continue;
    const auto text = ReadWhole(file, "the evidence");
    if (text.ok()) AddVersion("SHA-256 of " + file, Sha256Hex(*text), evidence);
  }
  utsname machine{};
  if (uname(&machine) == 0) AddVersion("machine", absl::StrCat(machine.sysname, " ", machine.machine), evidence);
  AddVersion("made", absl::FormatTime("%Y-%m-%d %H:%M UTC", absl::Now(), absl::UTCTimeZone()), evidence);
  AddVersion("command", CommandOf(options), evidence);
}

void PrintCredibility(const v1::CredibilityReport& report) {
  Table table({"section", "verdict", "required", "why"});
  for (const v1::SectionReport& section : report.sections()) {
    table.Add({absl::StrCat(static_cast<int>(section.section()), " ", section.title()), TextOf(section.verdict()),
               section.required() ? "yes" : "", section.reason()});
  }
  table.Print(std::cout);
  std::cout << "\nmissing\n";
  for (const v1::MissingRow& row : report.missing()) std::cout << "  " << row.section() << ": " << row.what() << "\n";
  std::cout << "\n"
            << report.scene()
            << (report.adequate() ? ": every required section is met\n" : ": NOT every required section is met\n");
}

absl::Status WriteCredibilityPage(const std::string& file, const std::string& web_root,
                                  const v1::CredibilityReport& report, const std::string& hash) {
  v1::Study study;
  study.set_state(v1::STUDY_STATE_DONE);
  study.set_scene(report.scene());
  study.mutable_result()->set_scene(report.scene());
  study.mutable_result()->set_scene_hash(hash);
  *study.mutable_result()->mutable_credibility() = report;
  const auto html = service::StudyPage(study, web_root);
  if (!html.ok()) return html.status();
  if (absl::Status written = WriteWhole(file, *html); !written.ok()) return written;
  std::cerr << "wrote " << file << "; for a PDF print it in a browser, or: chromium --headless --print-to-pdf=FILE.pdf "
            << file << "\n";
  return absl::OkStatus();
}

// Writes the JUnit file. Returns the exit code.
int CheckCredibility(const CredibilityOptions& options, const v1::CredibilityReport& report) {
  std::vector<CheckResult> checks;
  for (const v1::SectionReport& section : report.sections()) {
    CheckResult& check = checks.emplace_back();
    check.name = section.title();
    check.skipped = !section.required();
    if (section.verdict() != v1::SECTION_VERDICT_MET) {
      check.failure = absl::StrCat(TextOf(section.verdict()), ": ", section.reason());
    }
  }
  if (!options.junit_file.empty()) {
    const absl::Status written = WriteJUnit(options.junit_file, "credibility of " + report.scene(), checks);
    if (!written.ok()) return Fail(written);
  }
  return options.check && !report.adequate() ? kMissed : kOk;
}

absl::StatusOr<std::map<std::string, std::string>> FilesOf(const std::vector<std::string>& evidence) {
  std::map<std::string, std::string> files;
  for (const std::string& text : evidence) {
    const size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == text.size()) {
      return absl::InvalidArgumentError(absl::StrCat("--evidence: \"", text, "\" is not of the form NAME=FILE"));
    }
    files[text.substr(0, equals)] = text.substr(equals + 1);
  }
  return files;
}

// Makes the evidence and the report of a context. Errors are those of calls and files.
absl::StatusOr<v1::CredibilityReport> MakeReport(const Context& context, const CredibilityOptions& options,
                                                 const std::shared_ptr<grpc::Channel>& channel) {
  const auto text = ReadWhole(options.use, "the context of use");
  if (!text.ok()) return text.status();
  const auto use = ParseCredibilityContext(options.use, *text);
  if (!use.ok()) return use.status();
  const auto files = FilesOf(options.evidence);
  if (!files.ok()) return files.status();
  auto own = ReadOwnEvidence(*use, options.use, *files);
  if (!own.ok()) return own.status();
  const auto source = ReadScene(options.scene);
  if (!source.ok()) return source.status();
  EvidenceMaker maker(context, options, *use, *source, channel);
  maker.evidence.numbers = *std::move(own);
  if (absl::Status status = maker.Make(); !status.ok()) return status;
  AddVersions(options, *text, maker.evidence);
  return MakeCredibilityReport(*use, maker.evidence, maker.commands);
}

int Credibility(const Context& context, const CredibilityOptions& options) {
  service::ServerOptions server_options = LocalOptions(options.data_dir);
  auto server = service::Server::Start(server_options);
  if (!server.ok()) return Fail(server.status());
  const auto report = MakeReport(context, options, (*server)->InProcessChannel());
  if (!report.ok()) {
    if (context.interruption->happened()) return Fail(context, grpc::Status(grpc::StatusCode::CANCELLED, ""));
    return Fail(report.status());
  }
  if (context.json()) {
    std::cout << Json(*report) << "\n";
  } else {
    PrintCredibility(*report);
  }
  if (!options.page.empty()) {
    std::string hash;
    for (const v1::VersionRow& row : report->versions()) {
      if (row.of() == "hash of the compiled scene") hash = row.is();
    }
    const absl::Status written = WriteCredibilityPage(options.page, server_options.web_root, *report, hash);
    if (!written.ok()) return Fail(written);
  }
  return CheckCredibility(options, *report);
}

void AddFound(CLI::App& command, const char* flag, std::string& file, const std::string& of) {
  command.add_option(flag, file, "instead of running it, read the JSON of `" + of + "`");
}

}  // namespace

CommandFunction SetUpCredibility(CLI::App& command) {
  const auto options = std::make_shared<CredibilityOptions>();
  AddScene(command, options->scene);
  command.add_option("--use", options->use, "the context of use (.textproto, CredibilityContext)")->required();
  command.add_option("--page", options->page, "write the report to this .html file");
  command.add_option("--exact", options->exact, "the exact cases: JSON of build/exact_test --gtest_output=json:FILE");
  AddFound(command, "--orders", options->orders, "phrenic study error SCENE -o json");
  AddFound(command, "--convergence", options->convergence, "phrenic study convergence SCENE -o json");
  AddFound(command, "--sensitivity", options->sensitivity, "phrenic study sensitivity SCENE -o json");
  AddFound(command, "--uncertainty", options->uncertainty, "phrenic study uncertainty SCENE -o json");
  AddFound(command, "--physiology", options->physiology, "phrenic physiology SCENE -o json");
  command.add_option("--evidence", options->evidence, "a JSON file of the context's evidence; may be repeated")
      ->allow_extra_args(false);
  command.add_option("--budget", options->budget, "wall time after which nothing more is run [s]")
      ->check(NumberIn(0, 1e6))
      ->capture_default_str();
  AddDataFolder(command, options->data_dir);
  command.add_flag("--check", options->check, "exit code 4 if a required section is not met");
  AddJUnit(command, options->junit_file);
  return Bind(&Credibility, options);
}

}  // namespace phrenic::client
