// Requests to the gRPC port, of a server alone and of one in a cluster, that would be illegal if they were passed on;
// and a cluster over TLS.
#include "tests/support/raw_http2.h"
// After Boost, which needs <utility> first.
#include <grpcpp/generic/async_generic_service.h>
#include <grpcpp/server_builder.h>

#include <atomic>
#include <boost/asio/ip/tcp.hpp>
#include <filesystem>
#include <thread>

#include "absl/time/clock.h"
#include "server/cluster/cluster.h"
#include "server/service/net/metadata.h"
#include "tests/cluster/redis_server.h"
#include "tests/service/certificates.h"
#include "tests/service/server_fixture.h"
#include "tests/support/free_ports.h"

namespace phrenic::service {
namespace {

using cluster::RedisServer;
using testing::HasSubstr;

TEST(Metadata, WhatGrpcForbidsIsNamed) {
  const struct {
    const char *name, *value, *words;
  } cases[] = {{"", "a", "not a legal name"},    {":path", "a", ":path: not a legal name"},
               {"X-A", "a", "X-A: not a legal"}, {"grpc-timeout", "1S", "grpc-timeout: not a legal name"},
               {"x-\xe9", "a", "x-\\xe9: not"},  {"x-a", "\n", "x-a: its value"},
               {"x-a", "\x7f", "x-a: its value"}};
  for (const auto& one : cases) {
    EXPECT_THAT(std::string(CheckMetadata({{one.name, one.value}}).message()), HasSubstr(one.words)) << one.name;
  }
  EXPECT_TRUE(CheckMetadata({{"x-a-bin", "\n\xff"}, {"x-a", ""}, {"authorization", " ~"}}).ok());
  EXPECT_TRUE(absl::IsResourceExhausted(CheckMetadata({{"x-a", std::string(8192, 'a')}})));
  EXPECT_TRUE(CheckMethod("/a.B/C_1").ok());
  for (const char* bad : {"", "a/b", "/a", "//b", "/a/", "/a/b/", "/a/b c", "/\n/b"}) {
    EXPECT_FALSE(CheckMethod(bad).ok()) << bad;
  }
}

class GrpcEdge : public ServerFixture {
 protected:
  // Sends calls that gRPC receives but may not send, and expects that the server ends them and answers the next.
  void Attack() {
    const std::string path = "/phrenic.v1.SessionService/ListSessions";
    const std::vector<std::pair<std::string, http2::Headers>> calls = {{path, {{"authorization", "Bearer \xe9"}}},
                                                                       {path, {{"x-a", "a\tb"}}},
                                                                       {path, {{"x-a", std::string("a\0b\r\nc", 6)}}},
                                                                       {path, {{"x-a!b", "c"}}},
                                                                       {path, {{"x-\xe9", "c"}}},
                                                                       {path, {{"X-A", "c"}}},
                                                                       {path, {{"x-phrenic-via", "\xe9"}}},
                                                                       {path, {{"x-phrenic-peer", "\xe9"}}},
                                                                       {path, {{"x-session-id", "\xe9"}}},
                                                                       {path, {{"x-a-bin", "***"}}},
                                                                       {path, {{"x-a-bin", "/////w=="}}},
                                                                       {path, {{"x-a", std::string(7900, 'a')}}},
                                                                       {path, {{"grpc-timeout", "99999999H"}}},
                                                                       {path, {{"grpc-timeout", "1n"}}},
                                                                       {path, {{"grpc-encoding", "\xe9"}}},
                                                                       {"/\xe9/\n", {}},
                                                                       {"//", {}},
                                                                       {"nothing", {}},
                                                                       {"", {}}};
    for (const auto& [target, headers] : calls) {
      RawHttp2 client(server_->port());
      client.AwaitEnd(client.Call(target, headers));  // or gRPC closes the connection
      const grpc::Status status = Session(&v1::SessionService::Stub::ListSessions, "");
      ASSERT_TRUE(status.ok()) << status.error_message();
    }
  }
};

TEST_F(GrpcEdge, NoHeaderStopsAServer) { Attack(); }

TEST_F(GrpcEdge, TheLongestDeadlineOfACallIsNoOverflow) {
  RawHttp2 client(server_->port());
  EXPECT_TRUE(client.AwaitEnd(client.Call("/phrenic.v1.SessionService/ListSessions", {{"grpc-timeout", "99999999H"}})));
}

// A server in a cluster of its own.
class ClusterEdge : public GrpcEdge {
 protected:
  ClusterEdge() {
    if (!RedisServer::Installed()) return;
    redis_ = std::make_unique<RedisServer>();
    folder_ = absl::StrCat(testing::TempDir(), "/phrenic-edge-store-", getpid());
    std::filesystem::create_directories(folder_);
    options_.store_dir = folder_;
    options_.listen = absl::StrCat("127.0.0.1:", FreePorts());
    options_.cluster = {.redis = redis_->url(), .advertise = options_.listen};
  }
  ~ClusterEdge() override {
    server_.reset();
    if (!folder_.empty()) std::filesystem::remove_all(folder_);
  }
  void SetUp() override {
    if (redis_ == nullptr) GTEST_SKIP() << "there is no redis-server here (deploy/packages.txt)";
    GrpcEdge::SetUp();
  }

  std::unique_ptr<RedisServer> redis_;
  std::string folder_;
};

TEST_F(ClusterEdge, NoHeaderStopsAServerThatPassesCallsOn) { Attack(); }

// A server of the cluster that takes calls and answers none.
class HangingPeer : public grpc::CallbackGenericService {
 public:
  explicit HangingPeer(const std::string& address) {
    grpc::ServerBuilder builder;
    builder.AddListeningPort(address, grpc::InsecureServerCredentials());
    builder.RegisterCallbackGenericService(this);
    server_ = builder.BuildAndStart();
  }
  ~HangingPeer() override { server_->Shutdown(std::chrono::system_clock::now()); }
  grpc::ServerGenericBidiReactor* CreateReactor(grpc::GenericCallbackServerContext*) override {
    ++calls_;
    return new Call(cancelled_);
  }
  int calls() const { return calls_; }
  // True if the callers of all calls have left within the time.
  bool AwaitCancel(absl::Duration time) const {
    const absl::Time end = absl::Now() + time;
    while (cancelled_ < calls_ && absl::Now() < end) absl::SleepFor(absl::Milliseconds(5));
    return cancelled_ == calls_;
  }

 private:
  class Call final : public grpc::ServerGenericBidiReactor {
   public:
    explicit Call(std::atomic<int>& cancelled) : cancelled_(cancelled) {}
    void OnCancel() override {
      ++cancelled_;
      Finish(grpc::Status::CANCELLED);
    }
    void OnDone() override { delete this; }

   private:
    std::atomic<int>& cancelled_;
  };
  std::atomic<int> calls_ = 0, cancelled_ = 0;
  std::unique_ptr<grpc::Server> server_;
};

TEST_F(ClusterEdge, AListIsNoLongerAskedForWhenItsCallerHasGone) {
  const std::string address = absl::StrCat("127.0.0.1:", FreePorts());
  HangingPeer peer(address);
  auto joined = cluster::Cluster::Join({.redis = redis_->url(), .advertise = address});
  ASSERT_TRUE(joined.ok()) << joined.status();
  (*joined)->Start({.lost = [](const std::string&) {},
                    .take_over = [](const store::SavedSession&, std::int64_t) { return absl::OkStatus(); },
                    .copy_whole = [](const std::vector<std::string>&) {}});
  (*joined)->StartTakeovers();
  v1::ListSessionsResponse response;
  const absl::Time last = absl::Now() + absl::Seconds(30);
  while (peer.calls() == 0 && absl::Now() < last) {  // until the server knows the other one
    grpc::ClientContext brief;
    brief.set_deadline(std::chrono::system_clock::now() + std::chrono::milliseconds(300));
    sessions_->ListSessions(&brief, v1::ListSessionsRequest(), &response);
  }
  const int before = peer.calls();
  ASSERT_GT(before, 0);
  EXPECT_TRUE(peer.AwaitCancel(absl::Seconds(1))) << "it has the deadline of its caller";
  grpc::ClientContext context;
  std::thread caller([&] { sessions_->ListSessions(&context, v1::ListSessionsRequest(), &response); });
  while (peer.calls() == before && absl::Now() < last) absl::SleepFor(absl::Milliseconds(5));
  context.TryCancel();
  EXPECT_TRUE(peer.AwaitCancel(absl::Seconds(1))) << "it would end after 2 s by itself";
  caller.join();
  EXPECT_EQ(peer.calls(), before + 1);
  (*joined)->Leave();
}

// Two servers and Redis, which talk to each other over TLS only.
class ClusterOverTls : public testing::Test {
 protected:
  ClusterOverTls() {
    if (!RedisServer::Installed()) return;
    certificates_.Sign("server");
    tls_port_ = FreePorts();
    redis_ = std::make_unique<RedisServer>(std::vector<std::string>{
        "--tls-port", std::to_string(tls_port_), "--tls-cert-file", certificates_.File("server"), "--tls-key-file",
        certificates_.Key("server"), "--tls-ca-cert-file", certificates_.File("good"), "--tls-auth-clients", "yes"});
    folder_ = absl::StrCat(testing::TempDir(), "/phrenic-tls-stores-", getpid());
  }
  ~ClusterOverTls() override {
    servers_.clear();
    if (!folder_.empty()) std::filesystem::remove_all(folder_);
  }
  void SetUp() override {
    if (redis_ == nullptr) GTEST_SKIP() << "there is no redis-server here (deploy/packages.txt)";
  }
  // Starts a server that trusts the other ones, and Redis, by the authority `ca`.
  absl::Status Start(const std::string& ca) {
    ServerOptions options;
    options.listen = absl::StrCat("127.0.0.1:", FreePorts());
    options.store_dir = absl::StrCat(folder_, "/", servers_.size());
    std::filesystem::create_directories(options.store_dir);
    options.tls = {certificates_.File("server"), certificates_.Key("server"), certificates_.File("good")};
    options.cluster = {.redis = absl::StrCat("rediss://127.0.0.1:", tls_port_), .advertise = options.listen};
    if (!ca.empty()) options.cluster.tls.ca = certificates_.File(ca);
    auto server = Server::Start(options);
    if (!server.ok()) return server.status();
    servers_.push_back(*std::move(server));
    return absl::OkStatus();
  }
  std::unique_ptr<v1::SessionService::Stub> StubOf(std::size_t i) const {
    const std::string key = Certificates::Read(certificates_.Key("server"));
    const grpc::SslCredentialsOptions ssl = {Certificates::Read(certificates_.File("good")), key,
                                             Certificates::Read(certificates_.File("server"))};
    return v1::SessionService::NewStub(
        grpc::CreateChannel(absl::StrCat("127.0.0.1:", servers_[i]->port()), grpc::SslCredentials(ssl)));
  }

  Certificates certificates_;
  int tls_port_ = 0;
  std::unique_ptr<RedisServer> redis_;
  std::string folder_;
  std::vector<std::unique_ptr<Server>> servers_;
};

TEST_F(ClusterOverTls, CallsAreForwardedOverTls) {
  ASSERT_EQ(Start("good"), absl::OkStatus());
  ASSERT_EQ(Start("good"), absl::OkStatus());
  v1::CreateSessionRequest request;
  request.set_session_id("cube");
  request.mutable_source()->set_name("cube-springs");
  v1::CreateSessionResponse created;
  grpc::ClientContext creating;
  const grpc::Status made = StubOf(0)->CreateSession(&creating, request, &created);
  ASSERT_TRUE(made.ok()) << made.error_message();
  v1::GetSessionRequest asked;
  asked.set_session_id("cube");
  v1::GetSessionResponse got;
  grpc::ClientContext asking;
  asking.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(30));
  const grpc::Status forwarded = StubOf(1)->GetSession(&asking, asked, &got);
  EXPECT_TRUE(forwarded.ok()) << forwarded.error_message();
  EXPECT_EQ(got.session().id(), "cube");
}

TEST_F(ClusterOverTls, ARedisOfAnotherAuthorityIsNotTrusted) {
  const absl::Status refused = Start("evil");
  EXPECT_TRUE(absl::IsUnavailable(refused)) << refused;
  EXPECT_THAT(std::string(refused.message()), HasSubstr("--cluster: Redis at 127.0.0.1"));
  EXPECT_THAT(std::string(refused.message()), HasSubstr("certificate"));
}

TEST(ClusterOptions, AnotherMachinesRedisNeedsTls) {
  ServerOptions options;
  options.store_dir = testing::TempDir();
  options.cluster = {.redis = "redis://10.0.0.1:6379", .advertise = "10.0.0.2:50051"};
  EXPECT_THAT(std::string(CheckOptions(options).message()), HasSubstr("rediss://"));
  options.insecure_listen = true;
  EXPECT_TRUE(CheckOptions(options).ok());
  options.insecure_listen = false;
  options.cluster.redis = "rediss://10.0.0.1:6379";
  EXPECT_TRUE(CheckOptions(options).ok());
}

}  // namespace
}  // namespace phrenic::service
