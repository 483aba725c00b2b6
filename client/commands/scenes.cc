// `phrenic scenes`: the server's scenes.
#include "client/commands/commands.h"
#include "client/connection/connection.h"
#include "client/connection/errors.h"
#include "client/print/output.h"
#include "phrenic/v1/session.grpc.pb.h"

namespace phrenic::client {
namespace {

int ListScenes(const Context& context) {
  const auto stub = v1::SceneService::NewStub(Connect(context));
  v1::ListScenesResponse response;
  const grpc::Status status =
      Call(context, *stub, &v1::SceneService::Stub::ListScenes, v1::ListScenesRequest(), &response);
  if (!status.ok()) return Fail(context, status);
  Table table({"scene", "title", "description"});
  for (const v1::SceneSummary& scene : response.scenes()) table.Add({scene.name(), scene.title(), scene.description()});
  PrintList(context, response, table);
  return kOk;
}

}  // namespace

CommandFunction SetUpScenes(CLI::App&) { return ListScenes; }

}  // namespace phrenic::client
