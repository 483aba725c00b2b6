// `phrenic study`: error, stability, cost and streaming of a scene, here or on the server; the studies of a server.
#include <iostream>

#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "client/cli/scene_argument.h"
#include "client/commands/commands.h"
#include "client/files/limits.h"
#include "client/files/whole_file.h"
#include "client/print/junit.h"
#include "client/print/output.h"
#include "client/print/rows.h"
#include "client/terminal/progress.h"
#include "phrenic/v1/study.grpc.pb.h"
#include "server/service/server.h"

namespace phrenic::client {
namespace {

const google::protobuf::Message& TablesOf(const v1::StudyResult& result) {
  switch (result.result_case()) {
    case v1::StudyResult::kStability:
      return result.stability();
    case v1::StudyResult::kCost:
      return result.cost();
    case v1::StudyResult::kStreaming:
      return result.streaming();
    default:
      return result.error();
  }
}

std::string StateName(v1::StudyState state) {
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

// Draws the progress until the study has ended, and gives the study then.
grpc::Status WaitFor(const Context& context, v1::StudyService::Stub& stub, const std::string& id, v1::Study* study) {
  v1::WatchStudyRequest request;
  request.set_study_id(id);
  Progress progress(id, 1);
  return RideOut(context, [&](Heard heard) {
    grpc::ClientContext call;
    const Interruption::Scope scope(*context.interruption, call);
    const auto reader = stub.WatchStudy(&call, request);
    for (v1::WatchStudyResponse response; reader->Read(&response);) {
      heard();
      progress.Say(response.study().doing());
      progress.Update(response.study().progress());
      *study = response.study();
    }
    return reader->Finish();
  });
}

void PrintReference(const v1::Reference& reference) {
  std::cout << absl::StrFormat(
      "reference: %s, tolerance %g m; it errs by %.2g mm (largest), %.2g mm (RMS); %d evaluations, %.3g CPU seconds\n"
      "largest displacement: %.4g mm\n",
      reference.method(), reference.tolerance_m(), reference.error_max_mm(), reference.error_rms_mm(),
      reference.evaluations(), reference.cpu_s(), reference.largest_displacement_mm());
}

void PrintStreaming(const v1::StreamingTable& table) {
  std::cout << absl::StrFormat("\n%s\n%d vertices, %d frames; the shapes of \"basis\" take %d bytes once\n",
                               table.advice(), table.vertices(), table.frames(), table.basis_bytes());
}

void Print(const v1::StudyResult& result) {
  std::cout << absl::StrFormat("%s (scene %.12s), %.1f s\n", result.scene(), result.scene_hash(), result.took_s());
  if (result.has_error()) PrintReference(result.error().reference());
  PrintTables(TablesOf(result), std::cout);
  if (result.has_error()) std::cout << "\n" << result.error().advice() << "\n";
  if (result.has_streaming()) PrintStreaming(result.streaming());
  if (result.cost().has_growth_exponent()) {
    std::cout << absl::StrFormat("\ncost grows with vertices^%.3f\n", result.cost().growth_exponent());
  }
}

int WritePage(const Context& context, v1::StudyService::Stub& stub, const std::string& id, const std::string& file) {
  v1::GetStudyPageRequest request;
  request.set_study_id(id);
  v1::GetStudyPageResponse response;
  const grpc::Status status = Call(context, stub, &v1::StudyService::Stub::GetStudyPage, request, &response);
  if (!status.ok()) return Fail(context, status);
  if (const absl::Status written = WriteWhole(file, response.html()); !written.ok()) return Fail(written);
  std::cerr << "wrote " << file << "\n";
  return kOk;
}

int Check(const StudyOptions& options, const v1::StudyResult& result) {
  const auto limits = ReadStudyLimits(options.limits);
  if (!limits.ok()) return Fail(limits.status());
  std::vector<JudgedCase> cases;
  int kept = 0;
  for (const v1::StudyLimit& limit : limits->limits()) {
    v1::StudyLimits one;
    *one.add_limits() = limit;
    const auto passed = PassedLimits(one, TablesOf(result));
    if (!passed.ok()) return Fail(passed.status());
    for (const std::string& sentence : *passed) std::cerr << "phrenic: limit passed: " << sentence << "\n";
    cases.push_back({LimitText(limit), absl::StrJoin(*passed, "; ")});
    kept += passed->empty() ? 1 : 0;
  }
  std::cerr << absl::StrFormat("%d of %d limits kept\n", kept, limits->limits_size());
  if (!options.junit_file.empty()) {
    const absl::Status written = WriteJUnit(options.junit_file, "study of " + result.scene(), cases);
    if (!written.ok()) return Fail(written);
  }
  return kept == limits->limits_size() ? kOk : kMissed;
}

int Finish(const Context& context, const StudyOptions& options, v1::StudyService::Stub& stub, const std::string& id) {
  v1::Study study;
  const grpc::Status status = WaitFor(context, stub, id, &study);
  if (!status.ok()) return Fail(context, status);
  if (study.state() == v1::STUDY_STATE_FAILED) return Fail(absl::AbortedError(study.problem()));
  if (context.output == Output::kJson) {
    std::cout << Json(study.result()) << "\n";
  } else if (context.output == Output::kCsv) {
    PrintCsv(TablesOf(study.result()), std::cout);
  } else {
    Print(study.result());
  }
  if (!options.page.empty()) {
    if (const int code = WritePage(context, stub, id, options.page); code != kOk) return code;
  }
  return options.limits.empty() ? kOk : Check(options, study.result());
}

int Create(const Context& context, const StudyOptions& options, v1::StudyService::Stub& stub) {
  const auto source = ReadSceneArgument(options.scene.scene, options.scene.resolution_mm);
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
  if (!options.detach) return Finish(context, options, stub, id);
  std::cout << (context.json() ? Json(response.study()) : id) << "\n";
  if (!context.json()) std::cerr << "it goes on without you: phrenic study watch " << id << "\n";
  return kOk;
}

}  // namespace

int Study(const Context& context, const StudyOptions& options) {
  if (!options.limits.empty()) {
    if (const auto limits = ReadStudyLimits(options.limits); !limits.ok()) return Fail(limits.status());
  }
  if (context.server_given || options.detach)
    return Create(context, options, *v1::StudyService::NewStub(Connect(context)));
  service::ServerOptions server_options;
  server_options.data_dir = options.data_dir;
  auto server = service::Server::Start(server_options);
  if (!server.ok()) return Fail(server.status());
  return Create(context, options, *v1::StudyService::NewStub((*server)->InProcessChannel()));
}

int WatchStudy(const Context& context, const StudyOptions& options) {
  return Finish(context, options, *v1::StudyService::NewStub(Connect(context)), options.id);
}

int DeleteStudy(const Context& context, const StudyOptions& options) {
  v1::DeleteStudyRequest request;
  request.set_study_id(options.id);
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
    table.Add({study.id(), study.scene(), StateName(study.state()), absl::StrFormat("%.0f %%", 100 * study.progress()),
               study.state() == v1::STUDY_STATE_FAILED ? study.problem() : study.doing()});
  }
  PrintList(context, response, table);
  return kOk;
}

}  // namespace phrenic::client
