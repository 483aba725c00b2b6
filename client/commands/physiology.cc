// `phrenic physiology`: compares a scene's breaths with published ranges, with the server's own service in this
// process.
#include <iostream>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/cli/shared_options.h"
#include "client/commands/commands.h"
#include "client/connection/errors.h"
#include "client/connection/local_run.h"
#include "client/files/junit.h"
#include "client/files/whole_file.h"
#include "client/print/output.h"
#include "client/print/rows.h"
#include "client/print/table.h"
#include "client/terminal/progress.h"
#include "phrenic/v1/study.grpc.pb.h"
#include "server/service/server.h"
#include "server/service/study_page.h"

namespace phrenic::client {
namespace {

struct PhysiologyOptions {
  SceneOptions scene;
  std::vector<std::string> presets;  // empty: all
  std::string data_dir;
  bool check = false;            // true: a value out of range is a failure
  std::string page, junit_file;  // empty: none
};

const char* VerdictText(v1::Verdict verdict) {
  switch (verdict) {
    case v1::VERDICT_INSIDE:
      return "inside";
    case v1::VERDICT_OUTSIDE:
      return "OUTSIDE";
    case v1::VERDICT_NOT_JUDGED:
      return "not judged";
    default:
      return "not applicable";
  }
}

bool IsJudged(const v1::PhysiologyRow& row) {
  return row.verdict() == v1::VERDICT_INSIDE || row.verdict() == v1::VERDICT_OUTSIDE;
}

void PrintPhysiology(const v1::PhysiologyTable& result) {
  Table table({"breath", "what", "value", "accepted", "unit", "verdict", "note"});
  int inside = 0, judged = 0;
  for (const v1::PhysiologyRow& row : result.rows()) {
    judged += IsJudged(row) ? 1 : 0;
    inside += row.verdict() == v1::VERDICT_INSIDE ? 1 : 0;
    table.Add({row.breath(), row.what(),
               row.verdict() == v1::VERDICT_NOT_MODELLED ? "-" : absl::StrFormat("%.2f", row.value()),
               row.verdict() == v1::VERDICT_NOT_JUDGED ? "-" : absl::StrFormat("%g to %g", row.low(), row.high()),
               row.unit() == "1" ? "" : row.unit(), VerdictText(row.verdict()), row.note()});
  }
  table.Print(std::cout);
  std::cout << absl::StrFormat("%s: %d of %d inside the published ranges\n", result.scene(), inside, judged);
}

void PrintResult(const Context& context, v1::PhysiologyTable table) {
  if (context.json()) {
    std::cout << Json(table) << "\n";
  } else if (context.output == Output::kCsv) {
    table.clear_curves();
    PrintCsv(table, std::cout);
  } else {
    PrintPhysiology(table);
  }
}

// Writes the page with the curves, drawn as a study.
absl::Status WritePage(const std::string& file, const std::string& web_root, const v1::PhysiologyTable& table) {
  v1::Study study;
  study.set_state(v1::STUDY_STATE_DONE);
  study.set_scene(table.scene());
  study.mutable_result()->set_scene(table.scene());
  *study.mutable_result()->mutable_physiology() = table;
  const auto html = service::StudyPage(study, web_root);
  if (!html.ok()) return html.status();
  if (absl::Status written = WriteWhole(file, *html); !written.ok()) return written;
  std::cerr << "wrote " << file << "\n";
  return absl::OkStatus();
}

// Writes the JUnit file. Returns the exit code.
int CheckBreaths(const PhysiologyOptions& options, const v1::PhysiologyTable& table) {
  std::vector<CheckResult> checks;
  bool outside = false;
  for (const v1::PhysiologyRow& row : table.rows()) {
    CheckResult& check = checks.emplace_back();
    check.name = absl::StrCat(row.breath(), ": ", row.what());
    check.skipped = !IsJudged(row);
    if (row.verdict() != v1::VERDICT_OUTSIDE) continue;
    outside = true;
    check.failure = absl::StrFormat("%.4g is outside %g to %g %s", row.value(), row.low(), row.high(), row.unit());
    if (!row.note().empty()) absl::StrAppend(&check.failure, " (", row.note(), ")");
  }
  if (!options.junit_file.empty()) {
    const absl::Status written = WriteJUnit(options.junit_file, "physiology of " + table.scene(), checks);
    if (!written.ok()) return Fail(written);
  }
  return options.check && outside ? kMissed : kOk;
}

int Physiology(const Context& context, const PhysiologyOptions& options) {
  const absl::StatusOr<v1::SceneSource> source = ReadScene(options.scene);
  if (!source.ok()) return Fail(source.status());
  service::ServerOptions server_options = LocalOptions(options.data_dir);
  auto server = service::Server::Start(server_options);
  if (!server.ok()) return Fail(server.status());
  v1::CheckPhysiologyRequest request;
  *request.mutable_source() = *source;
  request.mutable_presets()->Assign(options.presets.begin(), options.presets.end());
  grpc::ClientContext call;
  const Interruption::Scope scope(*context.interruption, call);
  const auto stub = v1::StudyService::NewStub((*server)->InProcessChannel());
  const auto reader = stub->CheckPhysiology(&call, request);
  v1::CheckPhysiologyResponse response;
  {
    Progress progress("breathing", 1);
    while (reader->Read(&response) && !response.has_table()) progress.Update(response.progress());
  }
  if (const grpc::Status status = reader->Finish(); !status.ok()) return Fail(context, status);
  PrintResult(context, response.table());
  if (!options.page.empty()) {
    const absl::Status written = WritePage(options.page, server_options.web_root, response.table());
    if (!written.ok()) return Fail(written);
  }
  return CheckBreaths(options, response.table());
}

}  // namespace

CommandFunction SetUpPhysiology(CLI::App& command) {
  const auto options = std::make_shared<PhysiologyOptions>();
  AddScene(command, options->scene);
  command.add_option("--preset", options->presets, "only this preset of the scene; may be repeated (all)");
  AddDataFolder(command, options->data_dir);
  command.add_option("--page", options->page, "write tables and curves to this .html file");
  command.add_flag("--check", options->check, "exit code 4 if a value is out of its range");
  AddJUnit(command, options->junit_file);
  return Bind(&Physiology, options);
}

}  // namespace phrenic::client
