// `phrenic replay`: repeats a recorded run and compares the final state bit by bit.
#include <google/protobuf/util/json_util.h>

#include <iostream>
#include <nlohmann/json.hpp>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/cli/shared_options.h"
#include "client/commands/commands.h"
#include "client/connection/connection.h"
#include "client/connection/errors.h"
#include "client/connection/local_run.h"
#include "client/files/whole_file.h"
#include "client/terminal/progress.h"
#include "phrenic/v1/session.grpc.pb.h"
#include "server/service/server.h"

namespace phrenic::client {
namespace {

struct ReplayOptions {
  std::string file;
  SceneOptions scene;  // empty: the recorded one
  std::string data_dir;
};

// A recorded run.
struct Recorded {
  v1::Session session;
  std::string state_hash, scene_hash;  // scene_hash: empty if it was not recorded
};

absl::StatusOr<Recorded> ReadRecorded(const std::string& file) {
  const absl::StatusOr<std::string> text = ReadWhole(file, "the recorded run");
  if (!text.ok()) return text.status();
  const auto json = nlohmann::json::parse(*text, nullptr, false);
  if (!json.is_object() || !json.contains("session") || !json.contains("state_hash") ||
      !json["state_hash"].is_string()) {
    return absl::InvalidArgumentError(absl::StrCat(file,
                                                   ": session or state_hash is missing; write the file with `phrenic "
                                                   "run ... -o json` or `phrenic step ... -o json`"));
  }
  Recorded recorded;
  recorded.state_hash = json["state_hash"].get<std::string>();
  const nlohmann::json report = json.value("report", nlohmann::json::object());
  if (report.contains("scene_hash") && report["scene_hash"].is_string()) {
    recorded.scene_hash = report["scene_hash"].get<std::string>();
  }
  google::protobuf::util::JsonParseOptions options;
  options.ignore_unknown_fields = true;
  const auto parsed = google::protobuf::util::JsonStringToMessage(json["session"].dump(), &recorded.session, options);
  if (parsed.ok()) return recorded;
  return absl::InvalidArgumentError(absl::StrCat(file, ": session: ", std::string(parsed.message())));
}

absl::Status CheckScene(const Recorded& recorded, const v1::CompileReport& report) {
  if (recorded.scene_hash.empty() || recorded.scene_hash == report.scene_hash()) return absl::OkStatus();
  return absl::FailedPreconditionError(absl::StrFormat(
      "the scene differs from the recorded one: its hash is %.12s, not %.12s; name the recorded scene with --scene",
      report.scene_hash(), recorded.scene_hash));
}

grpc::Status StepAll(const Context& context, std::int64_t last, v1::SessionService::Stub& stub, v1::Session* session,
                     RunCost* cost) {
  Progress progress("stepping", static_cast<double>(last));
  return StepUntil(context, last, stub, session, cost,
                   [&](std::int64_t tick) { progress.Update(static_cast<double>(tick)); });
}

int ReportMatch(const Context& context, const Recorded& recorded, const std::string& hash) {
  const bool same = hash == recorded.state_hash;
  if (context.json()) {
    std::cout << nlohmann::json({{"same", same}, {"state_hash", hash}, {"recorded", recorded.state_hash}}).dump(1)
              << "\n";
  } else {
    std::cout << absl::StrFormat(
        "%s, %d steps: state hash %s, %s\n", recorded.session.scene(), recorded.session.tick(), hash,
        same ? "equal to the recorded one" : "not equal to the recorded " + recorded.state_hash);
  }
  return same ? kOk : kMissed;
}

int ReplayOn(const Context& context, const Recorded& recorded, const v1::SceneSource& source, service::Server& server) {
  const auto stub = v1::SessionService::NewStub(server.InProcessChannel());
  v1::CreateSessionRequest request;
  request.set_session_id("replay");
  *request.mutable_source() = source;
  *request.mutable_parameters() = recorded.session.parameters();
  *request.mutable_pulls() = recorded.session.pulls();
  v1::CreateSessionResponse created;
  grpc::Status status = WithProgress("compiling " + recorded.session.scene(), [&] {
    return Call(context, *stub, &v1::SessionService::Stub::CreateSession, request, &created);
  });
  if (!status.ok()) return Fail(context, status);
  v1::GetSessionRequest get;
  get.set_session_id("replay");
  v1::GetSessionResponse session;
  status = Call(context, *stub, &v1::SessionService::Stub::GetSession, get, &session);
  if (!status.ok()) return Fail(context, status);
  if (const absl::Status same = CheckScene(recorded, session.report()); !same.ok()) return Fail(same);
  RunCost cost;
  status = StepAll(context, recorded.session.tick(), *stub, session.mutable_session(), &cost);
  return status.ok() ? ReportMatch(context, recorded, cost.state_hash) : Fail(context, status);
}

int Replay(const Context& context, const ReplayOptions& options) {
  const auto recorded = ReadRecorded(options.file);
  if (!recorded.ok()) return Fail(recorded.status());
  if (recorded->session.tick() < 1) {
    return Fail(
        absl::InvalidArgumentError(absl::StrCat(options.file, ": session.tick: the recorded run has no steps")));
  }
  SceneOptions scene = options.scene;
  if (scene.scene.empty()) scene.scene = recorded->session.scene();
  const auto source = ReadScene(scene);
  if (!source.ok()) return Fail(source.status());
  service::ServerOptions server_options = LocalOptions(options.data_dir);
  auto server = service::Server::Start(server_options);
  if (!server.ok()) return Fail(server.status());
  return ReplayOn(context, *recorded, *source, **server);
}

}  // namespace

CommandFunction SetUpReplay(CLI::App& command) {
  const auto options = std::make_shared<ReplayOptions>();
  command.add_option("FILE", options->file, "the output of `phrenic run -o json` or `phrenic step -o json`")
      ->required();
  command.add_option("--scene", options->scene.scene,
                     "name of the scene, or a .textproto file (the one that FILE names)");
  AddResolution(command, options->scene.resolution_mm);
  AddPhysique(command, options->scene.physique);
  AddDataFolder(command, options->data_dir);
  return Bind(&Replay, options);
}

}  // namespace phrenic::client
