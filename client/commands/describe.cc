// `phrenic describe`: what the compiler made of a scene.
#include <iostream>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "client/cli/parameter_rows.h"
#include "client/cli/shared_options.h"
#include "client/commands/commands.h"
#include "client/connection/connection.h"
#include "client/connection/errors.h"
#include "client/print/output.h"
#include "client/print/print_session.h"
#include "client/print/table.h"
#include "client/terminal/progress.h"
#include "phrenic/v1/session.grpc.pb.h"

namespace phrenic::client {
namespace {

void PrintBodies(const v1::CompileReport& report) {
  Table table({"body", "layer", "role", "vertices", "edges", "triangles", "simulated"});
  for (const v1::BodyReport& body : report.bodies()) {
    table.Add({body.name(), body.layer(), body.role(), absl::StrCat(body.vertices()), absl::StrCat(body.edges()),
               absl::StrCat(body.triangles()), absl::StrCat(body.simulated_vertices())});
  }
  table.Print(std::cout);
}

void PrintElements(const v1::CompileReport& report) {
  std::cout << "\nWhat runs\n";
  Table runs({"family", "element", "number", "of", "detail"});
  for (const v1::ElementReport& element : report.elements()) {
    runs.Add({element.family(), element.name(), absl::StrCat(element.count()), element.counted(), element.detail()});
  }
  runs.Print(std::cout);
  std::cout << "\nWhat was left out\n";
  Table left_out({"what", "why"});
  for (const v1::LeftOut& row : report.left_out()) left_out.Add({row.what(), row.why()});
  if (left_out.empty()) left_out.Add({"nothing", ""});
  left_out.Print(std::cout);
}

void PrintReport(const v1::DescribeSceneResponse& response) {
  const v1::CompileReport& report = response.report();
  std::cout << response.scene().title() << " (" << response.scene().name() << ")\n"
            << response.scene().description() << "\n\n";
  PrintBodies(report);
  PrintElements(report);
  const v1::StableStep& step = report.stable_step();
  std::cout << absl::StrFormat(
      "\n%d simulated vertices, %d springs, %d rigid links, %d attachments\n"
      "Largest stable step %.4g s: %s\nInitial step %.4g s\nCompiled in %.2f s; scene hash %s\n",
      report.simulated_vertices(), report.springs(), report.rigid_links(), report.attachments(), step.seconds(),
      step.reason(), step.chosen_seconds(), report.compile_seconds(), report.scene_hash());
  if (response.scene().presets_size() > 0) std::cout << "\nPresets\n";
  for (const v1::Preset& preset : response.scene().presets()) {
    std::cout << absl::StrFormat("%s (%s): %s\n", preset.name(), preset.title(), ParametersLine(preset.parameters()));
    if (!preset.description().empty()) std::cout << "  " << preset.description() << "\n";
  }
  std::cout << "\nParameters\n" << ParametersLine(response.parameters()) << "\n";
  if (report.idle_parameters_size() > 0) {
    std::cout << "Without effect in this scene: " << absl::StrJoin(report.idle_parameters(), ", ") << "\n";
  }
  Table parameters({"parameter", "unit", "range", "default", "meaning"});
  for (const ParameterRow& row : ParameterRows()) {
    parameters.Add({row.name, row.unit, row.range, row.default_value, row.meaning});
  }
  parameters.Print(std::cout);
}

int Describe(const Context& context, const SceneOptions& options) {
  const absl::StatusOr<v1::SceneSource> source = ReadScene(options);
  if (!source.ok()) return Fail(source.status());
  v1::DescribeSceneRequest request;
  *request.mutable_source() = *source;
  const auto stub = v1::SceneService::NewStub(Connect(context));
  v1::DescribeSceneResponse response;
  const grpc::Status status = WithProgress("compiling " + options.scene, [&] {
    return Call(context, *stub, &v1::SceneService::Stub::DescribeScene, request, &response);
  });
  if (!status.ok()) return Fail(context, status);
  if (context.json()) {
    std::cout << Json(response) << "\n";
  } else {
    PrintReport(response);
  }
  return kOk;
}

}  // namespace

CommandFunction SetUpDescribe(CLI::App& command) {
  const auto options = std::make_shared<SceneOptions>();
  AddScene(command, *options);
  return Bind(&Describe, options);
}

}  // namespace phrenic::client
