// What the web gateway refuses at its edge: headers that gRPC forbids, hosts that were not named, ambiguous framing,
// and bodies of callers that are not known.
#include "tests/support/raw_socket.h"
// After Boost, which needs <utility> first.
#include <filesystem>
#include <map>
#include <thread>

#include "absl/strings/match.h"
#include "phrenic/v1/upload.pb.h"
#include "server/access/token_file.h"
#include "server/service/web/body_budget.h"
#include "server/service/web/hosts.h"
#include "tests/service/server_fixture.h"

namespace phrenic::service {
namespace {

using testing::HasSubstr;

// A POST of an empty message with these headers, each with its line end. The Host is localhost unless they have one.
std::string CallWith(const std::string& headers) {
  const std::string host = absl::StrContains(headers, "Host:") ? "" : "Host: localhost\r\n";
  const std::string body = WebMessage("");
  return absl::StrCat("POST /phrenic.v1.SessionService/ListSessions HTTP/1.1\r\n", host,
                      "Content-Type: application/grpc-web+proto\r\n", headers, "Content-Length: ", body.size(),
                      "\r\n\r\n", body);
}

class WebEdge : public ServerFixture {
 protected:
  WebEdge() { options_.allowed_origins = {"https://course.example"}; }

  RawSocket::Response Ask(const std::string& request) {
    RawSocket socket(server_->web_port());
    auto response = socket.Ask(request);
    EXPECT_TRUE(response.has_value()) << "the server disconnected after " << request.substr(0, 80);
    return response.value_or(RawSocket::Response());
  }
  void ExpectAlive() {
    EXPECT_TRUE(Session(&v1::SessionService::Stub::ListSessions, "").ok());
    EXPECT_EQ(Ask(CallWith("")).result(), http::status::ok);
  }
};

TEST_F(WebEdge, AHeaderThatGrpcForbidsIsRefusedWithItsName) {
  const struct {
    std::string header, name;
  } cases[] = {{"Authorization: Bearer \xe9", "authorization"},
               {"Authorization: a\tb", "authorization"},
               {"X-Join: \x80", "x-join"},
               {"X-A: \xc3\xa4", "x-a"},
               {"X-a!b: c", "x-a!b"},
               {"X-a~b: c", "x-a~b"},
               {"X-Data-Bin: ***", "x-data-bin"}};
  for (const auto& [header, name] : cases) {
    const auto response = Ask(CallWith(header + "\r\n"));
    EXPECT_EQ(response.result(), http::status::bad_request) << header;
    EXPECT_THAT(response.body(), HasSubstr(name + ":")) << header;
  }
  ExpectAlive();
}

TEST_F(WebEdge, LegalHeadersPassAsTheyAre) {
  for (const char* header : {"X-Data-Bin: AP8=", "X-Data-Bin: AP8, //8", "X-Empty:", "x-a.b_c-1: ~!@#", "Grpc-X: \xe9",
                             "X-Phrenic-Peer: \xe9", "X-Phrenic-Via: a"}) {
    EXPECT_EQ(Ask(CallWith(absl::StrCat(header, "\r\n"))).result(), http::status::ok) << header;
  }
}

TEST_F(WebEdge, MoreHeadersThanGrpcTakesAreRefused) {
  std::string headers;
  for (int i = 0; i < 12; ++i) absl::StrAppend(&headers, "X-", i, ": ", std::string(1000, 'x'), "\r\n");
  const auto response = Ask(CallWith(headers));
  EXPECT_EQ(response.result(), http::status::request_header_fields_too_large);
  EXPECT_THAT(response.body(), HasSubstr("8192 bytes"));
  ExpectAlive();
}

TEST_F(WebEdge, AnAddressThatIsNoMethodIsUnimplemented) {
  for (const char* target : {"/", "/a", "//", "/a/", "/a/b/c", "/phrenic.v1.SessionService/List%00Sessions",
                             "/phrenic.v1.SessionService/ListSessions?a=b", "/\xe9/\xe9"}) {
    const auto response = Ask(absl::StrCat("POST ", target,
                                           " HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/grpc-web\r\n"
                                           "Content-Length: 5\r\n\r\n",
                                           WebMessage("")));
    const auto frames = WebFrames(response.body());
    ASSERT_EQ(frames.size(), 1u) << target;
    EXPECT_THAT(frames[0].bytes, HasSubstr("grpc-status: 12\r\n")) << target;
  }
  ExpectAlive();
}

TEST_F(WebEdge, TheLongestDeadlineIsNoOverflow) {
  for (const char* timeout : {"99999999H", "99999999M", "99999999S", "99999999m"}) {
    const auto frames = WebFrames(Ask(CallWith(absl::StrCat("Grpc-Timeout: ", timeout, "\r\n"))).body());
    ASSERT_EQ(frames.size(), 2u) << timeout;
    EXPECT_EQ(frames[1].bytes, "grpc-status: 0\r\n") << timeout;
  }
}

TEST_F(WebEdge, OnlyAHostThatWasNamedIsAnswered) {
  for (const char* good : {"localhost", "LOCALHOST:80", "127.0.0.1", "127.0.0.1:8080", "[::1]:1", "course.example"}) {
    EXPECT_EQ(Ask(CallWith(absl::StrCat("Host: ", good, "\r\n"))).result(), http::status::ok) << good;
  }
  for (const char* bad : {"evil.example", "localhost.evil.example", "localhost:x", "localhost@evil.example", "10.1.2.3",
                          "[::2]", "127.0.0.1.evil.example", "localhost, evil.example", "localhost:1:2", "\xe9"}) {
    const auto response = Ask(CallWith(absl::StrCat("Host: ", bad, "\r\nOrigin: http://", bad, "\r\n")));
    EXPECT_EQ(response.result(), http::status::misdirected_request) << bad;
    EXPECT_THAT(response.body(), HasSubstr("--allow-host")) << bad;
    EXPECT_EQ(response.count(http::field::access_control_allow_origin), 0u) << bad;
  }
}

TEST_F(WebEdge, AHostIsGivenExactlyOnce) {
  EXPECT_EQ(Ask("GET / HTTP/1.1\r\n\r\n").result(), http::status::bad_request);
  EXPECT_EQ(Ask("GET / HTTP/1.0\r\n\r\n").result(), http::status::bad_request);
  EXPECT_EQ(Ask("GET / HTTP/1.1\r\nHost:\r\n\r\n").result(), http::status::bad_request);
  EXPECT_EQ(Ask("GET / HTTP/1.1\r\nHost: localhost\r\nHost: localhost\r\n\r\n").result(), http::status::bad_request);
  EXPECT_EQ(Ask("GET http://localhost/ HTTP/1.1\r\nHost: localhost\r\n\r\n").result(), http::status::bad_request);
}

TEST_F(WebEdge, FramingThatAProxyMayReadAnotherWayIsRefusedAndClosed) {
  const std::string head =
      "POST /phrenic.v1.SessionService/ListSessions HTTP/1.1\r\nHost: localhost\r\nContent-Type: "
      "application/grpc-web\r\n";
  for (const char* framing :
       {"Transfer-Encoding: gzip\r\n", "Transfer-Encoding: gzip, chunked\r\n", "Transfer-Encoding: identity\r\n",
        "Transfer-Encoding: xchunked\r\n", "Transfer-Encoding: chunked\r\nTransfer-Encoding: chunked\r\n",
        "Transfer-Encoding: chunked\r\nTransfer-Encoding: identity\r\n", "Transfer-Encoding:\r\n",
        "Content-Length: 5\r\nTransfer-Encoding: chunked\r\n", "Transfer-Encoding: chunked\r\nContent-Length: 5\r\n",
        "Content-Length: 5\r\nContent-Length: 5\r\n", "Content-Length: 5, 5\r\n", "Content-Length: +5\r\n",
        "Content-Type: text/plain\r\nContent-Length: 5\r\n", "Origin: http://localhost\r\nOrigin: http://localhost\r\n",
        "Authorization: a\r\nAuthorization: b\r\n"}) {
    RawSocket socket(server_->web_port());
    const auto response = socket.Ask(absl::StrCat(head, framing, "\r\n", WebMessage("")));
    ASSERT_TRUE(response.has_value()) << framing;
    EXPECT_EQ(response->result(), http::status::bad_request) << framing;
    EXPECT_FALSE(socket.Ask("GET / HTTP/1.1\r\nHost: localhost\r\n\r\n").has_value()) << framing;
  }
  ExpectAlive();
}

TEST_F(WebEdge, APreflightEchoesNamesOfHeadersOnly) {
  const std::string head = "OPTIONS / HTTP/1.1\r\nHost: localhost\r\nOrigin: https://course.example\r\n";
  for (const char* bad : {"a\tb", "\xe9", "a: b", "<script>"}) {
    const auto response = Ask(absl::StrCat(head, "Access-Control-Request-Headers: ", bad, "\r\n\r\n"));
    EXPECT_EQ(response.result(), http::status::bad_request) << bad;
  }
}

// A server with two accounts that takes messages of up to 1 MiB.
class GuardedWebEdge : public WebEdge {
 protected:
  GuardedWebEdge() {
    options_.accounts.tokens_file = absl::StrCat(testing::TempDir(), "/phrenic-edge-accounts-", getpid());
    options_.max_message_bytes = 1 << 20;
    options_.idle_seconds = 5;
    std::filesystem::remove(options_.accounts.tokens_file);
    for (const char* name : {"anna", "ben"}) {
      tokens_[name] = *access::AddToken(options_.accounts.tokens_file, {name, v1::ACCESS_ROLE_OWNER});
    }
  }
  ~GuardedWebEdge() override { std::filesystem::remove(options_.accounts.tokens_file); }

  // The head of a request with a body of `length` bytes; of nobody if `name` is empty.
  std::string Head(const std::string& name, const std::string& framing) {
    const std::string as = name.empty() ? "" : "Authorization: Bearer " + tokens_[name] + "\r\n";
    return absl::StrCat("POST /phrenic.v1.UploadService/AddUploadChunk HTTP/1.1\r\nHost: localhost\r\nContent-Type: ",
                        "application/grpc-web+proto\r\n", as, framing, "\r\n\r\n");
  }
  static std::string Length(std::size_t bytes) { return absl::StrCat("Content-Length: ", bytes); }

  std::map<std::string, std::string> tokens_;
};

TEST_F(GuardedWebEdge, ALongBodyOfACallerThatIsNotKnownIsRefusedBeforeItIsRead) {
  const auto refused = Ask(Head("", Length(65537)));
  EXPECT_EQ(refused.result(), http::status::unauthorized);
  EXPECT_THAT(refused.body(), HasSubstr("requires an account"));
  RawSocket chunked(server_->web_port());
  chunked.Send(Head("", "Transfer-Encoding: chunked"));
  for (int i = 0; i < 9; ++i) chunked.Send("4000\r\n" + std::string(0x4000, '\0') + "\r\n");
  const auto cut = chunked.Read();
  ASSERT_TRUE(cut.has_value());
  EXPECT_EQ(cut->result(), http::status::unauthorized);
  const std::string small = WebMessage(std::string(60'000, '\0'));
  EXPECT_EQ(Ask(Head("", Length(small.size())) + small).result(), http::status::ok) << "small ones reach the guard";
}

TEST_F(GuardedWebEdge, AKnownCallerSendsMessagesUpToTheLimit) {
  v1::AddUploadChunkRequest request;
  request.set_upload_id("u1");
  request.set_chunk(std::string(1'000'000, 'x'));
  const std::string body = WebMessage(request.SerializeAsString());
  const auto frames = WebFrames(Ask(Head("anna", Length(body.size())) + body).body());
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_THAT(frames[0].bytes, HasSubstr("grpc-status: 5\r\n")) << "there is no such upload";
  EXPECT_EQ(Ask(Head("anna", Length((1 << 20) + 6))).result(), http::status::payload_too_large);
}

TEST_F(GuardedWebEdge, OneCallersUnfinishedBodiesLeaveRoomForOthers) {
  const std::string start = Head("anna", Length(1'000'000)) + std::string(100'000, '\0');
  std::vector<std::unique_ptr<RawSocket>> sockets;
  for (int i = 0; i < 2; ++i) {
    sockets.push_back(std::make_unique<RawSocket>(server_->web_port()));
    sockets.back()->Send(start);
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(1000));  // until both heads are judged; no proof
  RawSocket third(server_->web_port());
  const auto refused = third.Ask(start);
  ASSERT_TRUE(refused.has_value());
  EXPECT_EQ(refused->result(), http::status::service_unavailable);
  EXPECT_THAT(refused->body(), HasSubstr("--max-message-mb"));
  const std::string body = WebMessage(std::string(200'000, '\0'));
  EXPECT_EQ(Ask(Head("ben", Length(body.size())) + body).result(), http::status::ok);
  // They are closed after idle_seconds, and their part is free again.
  for (const auto& socket : sockets) EXPECT_EQ(socket->ReadSome(1), "");
  EXPECT_EQ(Ask(Head("anna", Length(body.size())) + body).result(), http::status::ok);
}

TEST_F(GuardedWebEdge, AProxyIsToldWhoIsKnown) {
  const auto known = [&](const std::string& headers) {
    return Ask("GET /known HTTP/1.1\r\nHost: localhost\r\n" + headers + "\r\n").result_int();
  };
  EXPECT_EQ(known(""), 401u);
  EXPECT_EQ(known("Authorization: Bearer nonsense\r\n"), 401u);
  EXPECT_EQ(known("X-Join: nonsense\r\n"), 401u);
  EXPECT_EQ(known("Authorization: Bearer " + tokens_["anna"] + "\r\n"), 200u);
}

TEST(BodyBudget, SharesEndWithTheirRequests) {
  BodyBudget budget(100, 60);
  {
    BodyBudget::Share a(budget, "a"), more(budget, "a"), b(budget, "b");
    EXPECT_TRUE(a.GrowTo(40));
    EXPECT_TRUE(a.GrowTo(30)) << "it never shrinks";
    EXPECT_FALSE(more.GrowTo(21));
    EXPECT_TRUE(more.GrowTo(20));
    EXPECT_FALSE(b.GrowTo(41));
    EXPECT_TRUE(b.GrowTo(40));
    EXPECT_EQ(budget.used(), 100u);
    BodyBudget::Share moved = std::move(b);
    EXPECT_EQ(budget.used(), 100u);
  }
  EXPECT_EQ(budget.used(), 0u);
}

TEST(AllowedHosts, AnAddressIsAllowedWhereTheClientConnectedToIt) {
  const auto local = boost::asio::ip::make_address("::ffff:192.0.2.1");
  const AllowedHosts hosts({"Phrenic.Example", "[2001:db8::1]"}, {}, "0.0.0.0:80");
  EXPECT_TRUE(hosts.Allow("192.0.2.1:80", local, nullptr));
  EXPECT_FALSE(hosts.Allow("192.0.2.2", local, nullptr));
  EXPECT_FALSE(hosts.Allow("0.0.0.0", local, nullptr));
  EXPECT_TRUE(hosts.Allow("PHRENIC.example:8443", local, nullptr));
  EXPECT_TRUE(hosts.Allow("[2001:DB8:0::1]", local, nullptr));
  EXPECT_FALSE(hosts.Allow("2001:db8::1", local, nullptr));
  EXPECT_TRUE(AllowedHosts({}, {"https://a.example:1"}, "b.example:2").Allow("b.example", local, nullptr));
}

TEST(ServerOptions, OtherMachinesReachGrpcOnlyThroughAGuardOrOnRequest) {
  ServerOptions options;
  options.listen = "0.0.0.0:0";
  options.insecure_listen = true;
  const absl::Status refused = CheckOptions(options);
  EXPECT_TRUE(absl::IsFailedPrecondition(refused));
  EXPECT_THAT(std::string(refused.message()), HasSubstr("--unguarded-listen"));
  EXPECT_THAT(std::string(refused.message()), HasSubstr("nginx"));
  options.unguarded_listen = true;
  EXPECT_TRUE(CheckOptions(options).ok());
  options.allowed_hosts = {"http://a"};
  EXPECT_THAT(std::string(CheckOptions(options).message()), HasSubstr("--allow-host"));
}

}  // namespace
}  // namespace phrenic::service
