// `phrenic link`: links that admit others to a session.
#include <iomanip>
#include <iostream>
#include <nlohmann/json.hpp>

#include "absl/strings/str_cat.h"
#include "client/cli/argument_kinds.h"
#include "client/cli/shared_options.h"
#include "client/commands/commands.h"
#include "client/connection/connection.h"
#include "client/connection/errors.h"
#include "client/print/output.h"
#include "google/protobuf/util/time_util.h"
#include "phrenic/v1/access.grpc.pb.h"
#include "server/access/rules.h"

namespace phrenic::client {
namespace {

using Links = v1::AccessService::Stub;

struct LinkOptions {
  std::string id, role = "viewer";
  double hours = 168;
};

struct RevokeOptions {
  std::string id, link;
};

// Browsers do not send the text after # to a server, so that the secret appears in no log.
std::string AddressOf(const Context& context, const std::string& session, const std::string& secret) {
  const std::string viewer = ViewerLink(context, session);
  return viewer.empty() ? "" : absl::StrCat(viewer, "#join=", secret);
}

void PrintLink(const v1::JoinLink& link) {
  std::cout << link.id() << "  " << std::left << std::setw(10) << access::NameOf(link.role()) << "  until "
            << google::protobuf::util::TimeUtil::ToString(link.expire_time()) << "  by " << link.made_by() << "\n";
}

int CreateLink(const Context& context, const LinkOptions& options) {
  constexpr double kHour = 3600;  // [s]
  const auto stub = v1::AccessService::NewStub(Connect(context));
  v1::CreateLinkRequest request;
  request.set_session_id(options.id);
  request.set_role(access::RoleOf(options.role));
  request.set_time_to_live(kHour * options.hours);
  v1::CreateLinkResponse response;
  const grpc::Status status = Call(context, *stub, &Links::CreateLink, request, &response);
  if (!status.ok()) return Fail(context, status);
  const std::string address = AddressOf(context, options.id, response.secret());
  if (context.json()) {
    auto answer = nlohmann::ordered_json::parse(Json(response));
    if (!address.empty()) answer["viewer"] = address;
    std::cout << answer.dump() << "\n";
    return kOk;
  }
  PrintLink(response.link());
  std::cout << "  viewer: " << (address.empty() ? "not served" : address)
            << "\n  programs: PHRENIC_JOIN=" << response.secret() << "\n";
  return kOk;
}

int ListLinks(const Context& context, const std::string& id) {
  const auto stub = v1::AccessService::NewStub(Connect(context));
  v1::ListLinksRequest request;
  request.set_session_id(id);
  v1::ListLinksResponse response;
  const grpc::Status status = Call(context, *stub, &Links::ListLinks, request, &response);
  if (!status.ok()) return Fail(context, status);
  if (context.json()) {
    std::cout << Json(response) << "\n";
    return kOk;
  }
  for (const v1::JoinLink& link : response.links()) PrintLink(link);
  return kOk;
}

int RevokeLink(const Context& context, const RevokeOptions& options) {
  const auto stub = v1::AccessService::NewStub(Connect(context));
  v1::RevokeLinkRequest request;
  request.set_session_id(options.id);
  request.set_link_id(options.link);
  v1::RevokeLinkResponse response;
  const grpc::Status status = Call(context, *stub, &Links::RevokeLink, request, &response);
  return status.ok() ? kOk : Fail(context, status);
}

}  // namespace

CommandFunction SetUpLinkCreate(CLI::App& command) {
  const auto options = std::make_shared<LinkOptions>();
  AddSession(command, options->id);
  command.add_option("--role", options->role, "what the link permits: viewer or controller")->capture_default_str();
  command.add_option("--hours", options->hours, "how long the link is valid [h]")
      ->check(NumberIn(0.001, 8760.0))
      ->capture_default_str();
  return Bind(&CreateLink, options);
}

CommandFunction SetUpLinkList(CLI::App& command) { return SetUpWithSession(command, &ListLinks); }

CommandFunction SetUpLinkRevoke(CLI::App& command) {
  const auto options = std::make_shared<RevokeOptions>();
  AddSession(command, options->id);
  command.add_option("LINK", options->link, "id of the link; `phrenic link list` lists them")->required();
  return Bind(&RevokeLink, options);
}

}  // namespace phrenic::client
