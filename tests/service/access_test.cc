#include "tests/support/raw_socket.h"
// After Boost, which needs <utility> first.
#include <grpcpp/generic/generic_stub.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "absl/strings/str_replace.h"
#include "phrenic/v1/access.grpc.pb.h"
#include "server/access/rules.h"
#include "tests/service/guarded_server.h"

namespace phrenic::service {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// Calls a method by its path with an empty request, so that the test covers every method.
grpc::StatusCode CodeOfEmptyCall(grpc::GenericStub& stub, const std::string& method) {
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(10));
  grpc::CompletionQueue queue;
  const grpc::Slice empty;
  const grpc::ByteBuffer request(&empty, 1);
  grpc::ByteBuffer response;
  grpc::Status status;
  const auto call = stub.PrepareUnaryCall(&context, method, request, &queue);
  call->StartCall();
  call->Finish(&response, &status, nullptr);
  void* tag = nullptr;
  bool ok = false;
  queue.Next(&tag, &ok);
  return status.error_code();
}

TEST_F(GuardedServer, NoMethodAnswersAnUnauthenticatedCaller) {
  grpc::GenericStub stub(channel_);
  for (const access::Rule& rule : access::Rules()) {
    const std::size_t dot = rule.method.find('.');
    const std::string path = absl::StrCat("/phrenic.v1.", std::string(rule.method.substr(0, dot)), "/",
                                          std::string(rule.method.substr(dot + 1)));
    EXPECT_EQ(CodeOfEmptyCall(stub, path), rule.open ? grpc::OK : grpc::UNAUTHENTICATED) << path;
  }
}

TEST_F(GuardedServer, AnUnknownTokenIsRefusedAndNotEchoed) {
  grpc::ClientContext context;
  context.AddMetadata("authorization", "Bearer 00112233445566778899aabbccddeeff");
  v1::ListSessionsResponse response;
  const grpc::Status status = sessions_->ListSessions(&context, {}, &response);
  EXPECT_EQ(status.error_code(), grpc::UNAUTHENTICATED);
  EXPECT_EQ(status.error_message().find("00112233"), std::string::npos);
}

TEST_F(GuardedServer, RolesDecideWhatAnAccountMayDo) {
  EXPECT_EQ(Create("viewer", "a"), grpc::PERMISSION_DENIED);
  EXPECT_EQ(Create("controller", "a"), grpc::PERMISSION_DENIED);
  EXPECT_EQ(Create("owner", "a"), grpc::OK);
  EXPECT_EQ(Create("admin", "b"), grpc::OK);
}

TEST_F(GuardedServer, SessionsOfOtherAccountsAreNotFound) {
  ASSERT_EQ(Create("owner", "mine"), grpc::OK);
  EXPECT_THAT(Listed({"owner"}), ElementsAre("mine"));
  EXPECT_THAT(Listed({"admin"}), ElementsAre("mine"));
  for (const char* who : {"viewer", "controller", "other"}) {
    EXPECT_THAT(Listed({who}), IsEmpty()) << who;
    v1::GetSessionResponse there, not_there;
    const auto hidden = CallAs({who}, *sessions_, &Sessions::GetSession, "session_id: 'mine'", &there);
    const auto missing = CallAs({who}, *sessions_, &Sessions::GetSession, "session_id: 'none'", &not_there);
    EXPECT_EQ(hidden.error_code(), grpc::NOT_FOUND) << who;
    EXPECT_EQ(missing.error_code(), grpc::NOT_FOUND) << who;
    EXPECT_EQ(absl::StrReplaceAll(hidden.error_message(), {{"mine", "none"}}), missing.error_message());
    EXPECT_EQ(Code({who}, &Sessions::PlaySession, "session_id: 'mine'"), grpc::NOT_FOUND) << who;
    EXPECT_EQ(Code({who}, &Sessions::DeleteSession, "session_id: 'mine'"), grpc::NOT_FOUND) << who;
    EXPECT_EQ(Code({who}, &Sessions::ForkSession, "session_id: 'mine'"),
              who == std::string("other") ? grpc::NOT_FOUND : grpc::PERMISSION_DENIED)
        << who;
  }
  EXPECT_EQ(Code({"owner"}, &Sessions::DeleteSession, "session_id: 'mine'"), grpc::OK) << "without a control token";
}

TEST_F(GuardedServer, ALinkGrantsItsRoleUntilItIsRevoked) {
  ASSERT_EQ(Create("owner", "mine"), grpc::OK);
  ASSERT_EQ(Create("owner", "private"), grpc::OK);
  const auto watching = Link(""), controlling = Link("role: ACCESS_ROLE_CONTROLLER");
  const As guest{"", watching.secret()}, colleague{"viewer", controlling.secret()};
  EXPECT_THAT(Listed(guest), ElementsAre("mine"));
  EXPECT_EQ(Code(guest, &Sessions::GetSession, "session_id: 'mine'"), grpc::OK);
  EXPECT_EQ(Code(guest, &Sessions::PlaySession, "session_id: 'mine'"), grpc::PERMISSION_DENIED);
  EXPECT_EQ(Code(guest, &Sessions::GetSession, "session_id: 'private'"), grpc::NOT_FOUND);
  EXPECT_EQ(Code(colleague, &Sessions::PlaySession, "session_id: 'mine'"), grpc::OK);
  EXPECT_EQ(Code(colleague, &Sessions::DeleteSession, "session_id: 'mine'"), grpc::PERMISSION_DENIED);
  const auto links = v1::AccessService::NewStub(channel_);
  v1::RevokeLinkResponse revoked;
  const std::string name = absl::StrCat("session_id: 'mine' link_id: '", watching.link().id(), "'");
  using Links = v1::AccessService::Stub;
  EXPECT_EQ(CallAs(colleague, *links, &Links::RevokeLink, name, &revoked).error_code(), grpc::PERMISSION_DENIED);
  ASSERT_TRUE(CallAs({"owner"}, *links, &Links::RevokeLink, name, &revoked).ok());
  EXPECT_EQ(Code(guest, &Sessions::GetSession, "session_id: 'mine'"), grpc::UNAUTHENTICATED);
  EXPECT_EQ(Code(colleague, &Sessions::GetSession, "session_id: 'mine'"), grpc::OK) << "the other link";
}

TEST_F(GuardedServer, ALinkExpires) {
  ASSERT_EQ(Create("owner", "mine"), grpc::OK);
  const As guest{"", Link("time_to_live: 1").secret()};
  EXPECT_EQ(Code(guest, &Sessions::GetSession, "session_id: 'mine'"), grpc::OK);
  grpc::StatusCode code = grpc::OK;
  for (int i = 0; i < 60 && code == grpc::OK; ++i) {
    usleep(50'000);
    code = Code(guest, &Sessions::GetSession, "session_id: 'mine'");
  }
  EXPECT_EQ(code, grpc::UNAUTHENTICATED);
}

TEST_F(GuardedServer, RevokingALinkEndsItsStreams) {
  ASSERT_EQ(Create("owner", "mine"), grpc::OK);
  const auto made = Link("");
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(10));
  Sign({"", made.secret()}, context);
  v1::WatchFramesRequest request;
  request.set_session_id("mine");
  const auto reader = frames_->WatchFrames(&context, request);
  v1::WatchFramesResponse response;
  ASSERT_TRUE(reader->Read(&response));
  const auto links = v1::AccessService::NewStub(channel_);
  v1::RevokeLinkResponse revoked;
  ASSERT_TRUE(CallAs({"owner"}, *links, &v1::AccessService::Stub::RevokeLink,
                     absl::StrCat("session_id: 'mine' link_id: '", made.link().id(), "'"), &revoked)
                  .ok());
  while (reader->Read(&response)) continue;
  EXPECT_EQ(reader->Finish().error_code(), grpc::PERMISSION_DENIED);
}

TEST_F(GuardedServer, ExportsAreVisibleToTheirOwnersOnly) {
  ASSERT_EQ(Create("owner", "mine"), grpc::OK);
  using Exports = v1::ExportService::Stub;
  v1::CreateExportResponse made;
  const auto status = CallAs({"owner"}, *exports_, &Exports::CreateExport,
                             "export_id: 'e' session_id: 'mine' format: 'csv' seconds: 0.1", &made);
  ASSERT_TRUE(status.ok()) << status.error_message();
  for (const auto& [who, count] : {std::pair("owner", 1), {"admin", 1}, {"other", 0}}) {
    v1::ListExportsResponse listed;
    EXPECT_TRUE(CallAs({who}, *exports_, &Exports::ListExports, "", &listed).ok());
    EXPECT_EQ(listed.exports_size(), count) << who;
  }
  v1::DeleteExportResponse deleted;
  EXPECT_EQ(CallAs({"other"}, *exports_, &Exports::DeleteExport, "export_id: 'e'", &deleted).error_code(),
            grpc::NOT_FOUND);
}

TEST_F(GuardedServer, TheSessionLimitIsPerAccount) {
  ASSERT_EQ(Create("owner", "a"), grpc::OK);
  ASSERT_EQ(Create("owner", "b"), grpc::OK);
  EXPECT_EQ(Create("owner", "c"), grpc::RESOURCE_EXHAUSTED);
  EXPECT_EQ(Create("other", "c"), grpc::OK);
}

TEST_F(GuardedServer, TheAuditLogNamesCallersAndContainsNoSecret) {
  ASSERT_EQ(Create("owner", "mine"), grpc::OK);
  EXPECT_EQ(Code({"other"}, &Sessions::DeleteSession, "session_id: 'mine'"), grpc::NOT_FOUND);
  std::ifstream in(options_.audit_file);
  std::vector<nlohmann::json> lines;
  for (std::string line; std::getline(in, line);) {
    for (const auto& [name, token] : tokens_) EXPECT_EQ(line.find(token), std::string::npos);
    lines.push_back(nlohmann::json::parse(line));
  }
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0]["caller"], "owner");
  EXPECT_EQ(lines[0]["method"], "SessionService.CreateSession");
  EXPECT_EQ(lines[0]["session"], "mine");
  EXPECT_EQ(lines[0]["outcome"], "admitted");
  EXPECT_EQ(lines[1]["caller"], "other");
  EXPECT_EQ(lines[1]["outcome"], "NOT_FOUND");
}

TEST_F(GuardedServer, ARemovedAccountIsRefusedWithinSecondsAndItsStreamsEnd) {
  ASSERT_EQ(Create("owner", "mine"), grpc::OK);
  ASSERT_EQ(Code({"owner"}, &Sessions::PlaySession, "session_id: 'mine'"), grpc::OK);
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(20));
  Sign({"owner"}, context);
  v1::WatchFramesRequest request;
  request.set_session_id("mine");
  const auto reader = frames_->WatchFrames(&context, request);
  v1::WatchFramesResponse response;
  ASSERT_TRUE(reader->Read(&response));
  ASSERT_TRUE(access::RemoveToken(options_.accounts.tokens_file, "owner").ok());
  while (reader->Read(&response)) continue;
  EXPECT_EQ(reader->Finish().error_code(), grpc::PERMISSION_DENIED);
  EXPECT_EQ(Code({"owner"}, &Sessions::GetSession, "session_id: 'mine'"), grpc::UNAUTHENTICATED);
}

// Browsers pass the same guard: they are not mistaken for calls of the process itself, which need no account.
class GuardedGateway : public GuardedServer {
 protected:
  std::string TrailersOf(const std::string& headers) {
    RawSocket socket(server_->web_port());
    const std::string body = WebMessage("");
    const auto response = socket.Ask(
        absl::StrCat("POST /phrenic.v1.SessionService/ListSessions HTTP/1.1\r\nHost: localhost\r\nContent-Type: "
                     "application/grpc-web+proto\r\n",
                     headers, "Content-Length: ", body.size(), "\r\n\r\n", body));
    EXPECT_TRUE(response.has_value());
    const auto frames = WebFrames(response.has_value() ? response->body() : "");
    return frames.empty() ? "" : frames.back().bytes;
  }
};

TEST_F(GuardedGateway, TheHeadersIdentifyTheCaller) {
  EXPECT_THAT(TrailersOf(""), HasSubstr("grpc-status: 16"));
  EXPECT_THAT(TrailersOf("X-Phrenic-Peer: \r\n"), HasSubstr("grpc-status: 16"));
  EXPECT_THAT(TrailersOf("Authorization: Bearer nonsense\r\n"), HasSubstr("grpc-status: 16"));
  EXPECT_THAT(TrailersOf("Authorization: Bearer " + tokens_["viewer"] + "\r\n"), HasSubstr("grpc-status: 0"));
}

TEST_F(GuardedGateway, MetricsRequireAnAdministrator) {
  const auto ask = [&](const std::string& page, const std::string& headers) {
    RawSocket socket(server_->web_port());
    return socket.Ask("GET " + page + " HTTP/1.1\r\nHost: localhost\r\n" + headers + "\r\n")
        .value_or(RawSocket::Response());
  };
  EXPECT_EQ(ask("/metrics", "").result_int(), 401u);
  EXPECT_EQ(ask("/metrics", "Authorization: Bearer " + tokens_["owner"] + "\r\n").result_int(), 401u);
  ASSERT_EQ(Create("owner", "secret-name"), grpc::OK);
  const auto numbers = ask("/metrics", "Authorization: Bearer " + tokens_["admin"] + "\r\n");
  EXPECT_EQ(numbers.result_int(), 200u);
  EXPECT_THAT(numbers.body(), HasSubstr("\nphrenic_sessions 1\n"));
  EXPECT_EQ(numbers.body().find("secret-name"), std::string::npos);
  EXPECT_EQ(ask("/healthz", "").result_int(), 200u);
  EXPECT_EQ(ask("/readyz", "").result_int(), 200u);
}

// A server without accounts.
class OpenServer : public ServerFixture {};

TEST_F(OpenServer, EveryCallIsAllowedAndLinksAreRefusedWithTheReason) {
  CreateCube("cube");
  const auto access = v1::AccessService::NewStub(channel_);
  v1::GetAccessResponse who;
  ASSERT_TRUE(Call(*access, &v1::AccessService::Stub::GetAccess, "", &who).ok());
  EXPECT_FALSE(who.accounts());
  EXPECT_EQ(who.role(), v1::ACCESS_ROLE_ADMIN);
  v1::CreateLinkResponse made;
  const auto status = Call(*access, &v1::AccessService::Stub::CreateLink, "session_id: 'cube'", &made);
  EXPECT_EQ(status.error_code(), grpc::FAILED_PRECONDITION);
  EXPECT_THAT(status.error_message(), HasSubstr("--tokens"));
}

}  // namespace
}  // namespace phrenic::service
