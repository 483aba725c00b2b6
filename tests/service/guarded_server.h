// A server with accounts, and calls under their names.
#ifndef PHRENIC_TESTS_SERVICE_GUARDED_SERVER_H_
#define PHRENIC_TESTS_SERVICE_GUARDED_SERVER_H_

#include <unistd.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "phrenic/v1/access.grpc.pb.h"
#include "server/access/rules.h"
#include "server/access/token_file.h"
#include "tests/service/server_fixture.h"

namespace phrenic::service {

// A server with five accounts.
class GuardedServer : public ServerFixture {
 protected:
  GuardedServer() {
    options_.accounts.tokens_file = absl::StrCat(testing::TempDir(), "/phrenic-accounts-", getpid());
    options_.audit_file = absl::StrCat(testing::TempDir(), "/phrenic-audit-", getpid());
    options_.limits.sessions_of_user = 2;
    Forget();
    for (const char* name : {"viewer", "controller", "owner", "admin"}) Add(name, access::RoleOf(name));
    Add("other", v1::ACCESS_ROLE_OWNER);
  }
  ~GuardedServer() override { Forget(); }
  void Forget() const {
    std::filesystem::remove(options_.accounts.tokens_file);
    std::filesystem::remove(options_.audit_file);
  }
  void Add(const std::string& name, v1::AccessRole role) {
    tokens_[name] = *access::AddToken(options_.accounts.tokens_file, {name, role});
  }

  // Metadata of a call: the account, "" for none, and the secret of a join link.
  struct As {
    std::string name;
    std::string link = "";
  };
  template <class Stub, class Request, class Response>
  grpc::Status CallAs(const As& who, Stub& stub,
                      grpc::Status (Stub::*method)(grpc::ClientContext*, const Request&, Response*),
                      const std::string& text, Response* response) {
    return Call(stub, method, text, response, [&](grpc::ClientContext& context) { Sign(who, context); });
  }
  void Sign(const As& who, grpc::ClientContext& context) const {
    if (!who.name.empty()) context.AddMetadata("authorization", "Bearer " + tokens_.at(who.name));
    if (!who.link.empty()) context.AddMetadata("x-join", who.link);
  }
  // Returns the status code of a call to SessionService.
  template <class Request, class Response>
  grpc::StatusCode Code(const As& who,
                        grpc::Status (v1::SessionService::Stub::*method)(grpc::ClientContext*, const Request&,
                                                                         Response*),
                        const std::string& text) {
    Response response;
    return CallAs(who, *sessions_, method, text, &response).error_code();
  }
  using Sessions = v1::SessionService::Stub;

  grpc::StatusCode Create(const std::string& who, const std::string& id) {
    return Code({who}, &Sessions::CreateSession,
                absl::StrCat("session_id: '", id, "' source { name: 'cube-springs' }"));
  }
  std::vector<std::string> Listed(const As& who) {
    v1::ListSessionsResponse listed;
    EXPECT_TRUE(CallAs(who, *sessions_, &Sessions::ListSessions, "", &listed).ok());
    std::vector<std::string> ids;
    for (const v1::Session& session : listed.sessions()) ids.push_back(session.id());
    return ids;
  }
  v1::CreateLinkResponse Link(const std::string& more) {
    const auto links = v1::AccessService::NewStub(channel_);
    v1::CreateLinkResponse made;
    const auto status =
        CallAs({"owner"}, *links, &v1::AccessService::Stub::CreateLink, "session_id: 'mine' " + more, &made);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return made;
  }

  std::map<std::string, std::string> tokens_;
};

}  // namespace phrenic::service

#endif  // PHRENIC_TESTS_SERVICE_GUARDED_SERVER_H_
