// `phrenic sessions`: the server's sessions.
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/commands/commands.h"
#include "client/connection/connection.h"
#include "client/connection/errors.h"
#include "client/print/output.h"
#include "client/print/print_session.h"
#include "phrenic/v1/session.grpc.pb.h"

namespace phrenic::client {
namespace {

int ListSessions(const Context& context) {
  const auto stub = v1::SessionService::NewStub(Connect(context));
  v1::ListSessionsResponse all;
  v1::ListSessionsRequest request;
  do {
    v1::ListSessionsResponse page;
    const grpc::Status status = Call(context, *stub, &v1::SessionService::Stub::ListSessions, request, &page);
    if (!status.ok()) return Fail(context, status);
    request.set_page_token(page.next_page_token());
    all.mutable_sessions()->MergeFrom(page.sessions());
  } while (!request.page_token().empty());
  Table table({"session", "scene", "state", "t [s]", "tick", "viewers", "x real time"});
  for (const v1::Session& session : all.sessions()) {
    table.Add({session.id(), session.scene(), StateName(session.state()), absl::StrFormat("%.2f", session.time()),
               absl::StrCat(session.tick()), absl::StrCat(session.viewers()),
               absl::StrFormat("%.2f", session.pace().times_real_time())});
  }
  PrintList(context, all, table);
  return kOk;
}

}  // namespace

CommandFunction SetUpSessions(CLI::App&) { return ListSessions; }

}  // namespace phrenic::client
