// Links that let others into a session.
#include <iomanip>
#include <iostream>
#include <nlohmann/json.hpp>

#include "absl/strings/str_cat.h"
#include "client/commands/commands.h"
#include "google/protobuf/util/time_util.h"
#include "phrenic/v1/access.grpc.pb.h"
#include "server/access/rules.h"

namespace phrenic::client {
namespace {

using Links = v1::AccessService::Stub;

// What follows # is sent to no server and stands in no log.
std::string AddressOf(const Context& context, const std::string& session, const std::string& secret) {
  const std::string viewer = ViewerLink(context, session);
  return viewer.empty() ? "" : absl::StrCat(viewer, "#join=", secret);
}

void PrintLink(const v1::JoinLink& link) {
  std::cout << link.id() << "  " << std::left << std::setw(10) << access::NameOf(link.role()) << "  until "
            << google::protobuf::util::TimeUtil::ToString(link.expire_time()) << "  by " << link.made_by() << "\n";
}

}  // namespace

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

int ListLinks(const Context& context, const LinkOptions& options) {
  const auto stub = v1::AccessService::NewStub(Connect(context));
  v1::ListLinksRequest request;
  request.set_session_id(options.id);
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

int RevokeLink(const Context& context, const LinkOptions& options) {
  const auto stub = v1::AccessService::NewStub(Connect(context));
  v1::RevokeLinkRequest request;
  request.set_session_id(options.id);
  request.set_link_id(options.link);
  v1::RevokeLinkResponse response;
  const grpc::Status status = Call(context, *stub, &Links::RevokeLink, request, &response);
  return status.ok() ? kOk : Fail(context, status);
}

}  // namespace phrenic::client
