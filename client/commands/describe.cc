// `phrenic describe`: what the compiler made of a scene.
#include <algorithm>
#include <iostream>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "client/cli/parameter_rows.h"
#include "client/cli/shared_options.h"
#include "client/commands/commands.h"
#include "client/connection/connection.h"
#include "client/connection/errors.h"
#include "client/connection/local_run.h"
#include "client/print/output.h"
#include "client/print/print_session.h"
#include "client/print/table.h"
#include "client/terminal/progress.h"
#include "phrenic/v1/session.grpc.pb.h"
#include "server/service/server.h"

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

// Returns the parameters of the preset that differ from the initial ones of the scene.
v1::Parameters ChangesOf(const v1::Preset& preset, const v1::Parameters& initial) {
  v1::Parameters changes = preset.parameters();
  const google::protobuf::Descriptor& type = *v1::Parameters::descriptor();
  for (int f = 0; f < type.field_count(); ++f) {
    const google::protobuf::FieldDescriptor& field = *type.field(f);
    const bool same = ParameterValue(changes, field) == ParameterValue(initial, field);
    if (same) changes.GetReflection()->ClearField(&changes, &field);
  }
  return changes;
}

void PrintPreset(const v1::Preset& preset, const v1::Parameters& initial) {
  const std::string title = preset.title().empty() ? "" : absl::StrCat(" (", preset.title(), ")");
  const std::string changes = ParametersLine(ChangesOf(preset, initial));
  std::cout << preset.name() << title << ": " << (changes.empty() ? "the initial parameters" : changes) << "\n";
  if (!preset.description().empty()) std::cout << "  " << preset.description() << "\n";
}

// Prints the presets by group, in the order in which the scene names the groups first.
void PrintPresets(const v1::DescribeSceneResponse& response) {
  std::vector<std::string> groups;
  for (const v1::Preset& preset : response.scene().presets()) {
    if (std::ranges::find(groups, preset.group()) == groups.end()) groups.push_back(preset.group());
  }
  for (const std::string& group : groups) {
    std::cout << "\nPresets" << (group.empty() ? "" : ": " + group) << "\n";
    for (const v1::Preset& preset : response.scene().presets()) {
      if (preset.group() == group) PrintPreset(preset, response.parameters());
    }
  }
}

// Prints the parameters that have an effect in the scene, by group, and the names of the others.
void PrintParameters(const v1::DescribeSceneResponse& response) {
  const auto& idle = response.report().idle_parameters();
  std::cout << "\nParameters\n";
  Table parameters({"group", "parameter", "initial", "unit", "range", "default", "meaning"});
  std::string group;
  for (const ParameterRow& row : ParameterRows()) {
    if (std::ranges::find(idle, row.name) != idle.end()) continue;
    const auto& field = *v1::Parameters::descriptor()->FindFieldByName(row.name);
    parameters.Add({row.group == group ? "" : row.group, row.name, ParameterValue(response.parameters(), field),
                    row.unit, row.range, row.default_value, row.meaning});
    group = row.group;
  }
  parameters.Print(std::cout);
  if (!idle.empty()) std::cout << "Without effect in this scene: " << absl::StrJoin(idle, ", ") << "\n";
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
  PrintPresets(response);
  PrintParameters(response);
}

struct DescribeOptions {
  SceneOptions scene;
  std::string data_dir;
};

int DescribeOn(const Context& context, const DescribeOptions& options, v1::SceneService::Stub& stub) {
  const absl::StatusOr<v1::SceneSource> source = ReadScene(options.scene);
  if (!source.ok()) return Fail(source.status());
  v1::DescribeSceneRequest request;
  *request.mutable_source() = *source;
  v1::DescribeSceneResponse response;
  const grpc::Status status = WithProgress("compiling " + options.scene.scene, [&] {
    return Call(context, stub, &v1::SceneService::Stub::DescribeScene, request, &response);
  });
  if (!status.ok()) return Fail(context, status);
  if (context.json()) {
    std::cout << Json(response) << "\n";
  } else {
    PrintReport(response);
  }
  return kOk;
}

int Describe(const Context& context, const DescribeOptions& options) {
  if (context.server_given) return DescribeOn(context, options, *v1::SceneService::NewStub(Connect(context)));
  auto server = service::Server::Start(LocalOptions(options.data_dir));
  if (!server.ok()) return Fail(server.status());
  return DescribeOn(context, options, *v1::SceneService::NewStub((*server)->InProcessChannel()));
}

}  // namespace

CommandFunction SetUpDescribe(CLI::App& command) {
  const auto options = std::make_shared<DescribeOptions>();
  AddScene(command, options->scene);
  AddDataFolder(command, options->data_dir);
  return Bind(&Describe, options);
}

}  // namespace phrenic::client
