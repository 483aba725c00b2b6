// Calls of one connection, one account or callers without one never occupy the server.
#include "tests/service/process_fixture.h"
#include "tests/support/raw_http2.h"
// After Boost, which needs <utility> first.
#include <gmock/gmock.h>
#include <google/protobuf/descriptor.h>
#include <google/protobuf/text_format.h>
#include <grpcpp/generic/generic_stub.h>

#include <filesystem>
#include <set>

#include "absl/strings/str_cat.h"
#include "phrenic/v1/server.grpc.pb.h"
#include "phrenic/v1/session.grpc.pb.h"
#include "phrenic/v1/study.grpc.pb.h"
#include "server/access/rules.h"
#include "server/access/token_file.h"

namespace phrenic::service {
namespace {

using testing::HasSubstr;

#ifdef PHRENIC_SANITIZED
constexpr int kPatience = 60;  // [s]
#else
constexpr int kPatience = 20;
#endif

constexpr char kReflection[] = "/grpc.reflection.v1alpha.ServerReflection/ServerReflectionInfo";

grpc::ByteBuffer Bytes(const std::string& text) {
  const grpc::Slice slice(text);
  return grpc::ByteBuffer(&slice, 1);
}

std::string Text(const grpc::ByteBuffer& bytes) {
  std::vector<grpc::Slice> slices;
  bytes.Dump(&slices);
  std::string text;
  for (const grpc::Slice& slice : slices) text.append(slice.begin(), slice.end());
  return text;
}

// Streams of any method on one connection, which send one message each and stay open.
class OpenStreams {
 public:
  explicit OpenStreams(std::shared_ptr<grpc::Channel> channel) : stub_(std::move(channel)) {}
  ~OpenStreams() {
    for (auto& each : calls_) each->context.TryCancel();
    for (auto& each : calls_) each->call->Finish(&each->status, each.get());
    std::size_t ended = 0;
    void* tag = nullptr;
    bool ok = false;
    while (ended < calls_.size() && queue_.Next(&tag, &ok)) ended += tag == nullptr ? 0 : 1;
  }
  OpenStreams(const OpenStreams&) = delete;
  OpenStreams& operator=(const OpenStreams&) = delete;

  void Open(const std::string& method, const std::string& message, const std::string& token = "") {
    calls_.push_back(std::make_unique<Call>());
    Call& call = *calls_.back();
    if (!token.empty()) call.context.AddMetadata("authorization", "Bearer " + token);
    call.call = stub_.PrepareCall(&call.context, method, &queue_);
    call.call->StartCall(nullptr);
    Next();
    call.call->Write(Bytes(message), nullptr);
    Next();
  }
  // The same, and waits for the first response, or for the end.
  void OpenAndRead(const std::string& method, const std::string& message) {
    Open(method, message);
    calls_.back()->call->Read(&calls_.back()->response, nullptr);
    Next();
  }

 private:
  struct Call {
    grpc::ClientContext context;
    std::unique_ptr<grpc::GenericClientAsyncReaderWriter> call;
    grpc::ByteBuffer response;
    grpc::Status status;
  };
  void Next() {
    void* tag = nullptr;
    bool ok = false;
    queue_.Next(&tag, &ok);
  }

  grpc::GenericStub stub_;
  grpc::CompletionQueue queue_;
  std::vector<std::unique_ptr<Call>> calls_;
};

class Calls : public ProcessFixture {
 protected:
  void StartGuarded() {
    const std::string tokens = folder_ + "/tokens";
    for (const char* name : {"greedy", "modest"}) {
      tokens_[name] = *access::AddToken(tokens, {name, v1::ACCESS_ROLE_OWNER});
    }
    Start({"--tokens", tokens});
  }
  // Calls as the account `name`, or as nobody.
  template <class Stub, class Request, class Response>
  grpc::Status Call(const std::unique_ptr<Stub>& stub,
                    grpc::Status (Stub::*method)(grpc::ClientContext*, const Request&, Response*),
                    const Request& request, const std::string& name = "") {
    grpc::ClientContext context;
    context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(kPatience));
    if (!name.empty()) context.AddMetadata("authorization", "Bearer " + tokens_.at(name));
    Response response;
    return (stub.get()->*method)(&context, request, &response);
  }
  grpc::Status List(const std::string& name = "") {
    return Call(v1::SessionService::NewStub(server_->NewChannel()), &v1::SessionService::Stub::ListSessions,
                v1::ListSessionsRequest(), name);
  }
  grpc::Status Create(const std::string& name = "") {
    v1::CreateSessionRequest request;
    request.mutable_source()->set_name("cube-springs");
    return Call(v1::SessionService::NewStub(server_->NewChannel()), &v1::SessionService::Stub::CreateSession, request,
                name);
  }
  bool Ready() const {
    RawSocket socket(server_->web_port());
    const auto response = socket.Ask("GET /readyz HTTP/1.1\r\nHost: localhost\r\n\r\n");
    return response.has_value() && response->result() == http::status::ok;
  }
  bool AwaitReady(bool ready) const {
    const absl::Time start = absl::Now();
    while (Ready() != ready && absl::Now() - start < absl::Seconds(kPatience)) absl::SleepFor(absl::Milliseconds(100));
    return Ready() == ready;
  }

  std::map<std::string, std::string> tokens_;
};

TEST_F(Calls, OpenReflectionStreamsBlockNoOther) {
  Start();
  OpenStreams streams(server_->NewChannel());
  for (int i = 0; i < 120; ++i) streams.Open(kReflection, "");
  const std::int64_t threads = server_->Threads();
  EXPECT_TRUE(List().ok());
  EXPECT_TRUE(Create().ok());
  EXPECT_TRUE(Ready());
  EXPECT_LT(threads, 60) << "streams that wait occupy threads";
}

TEST_F(Calls, LongCallsOfOneConnectionBlockNoOther) {
  Start();
  v1::DescribeSceneRequest describe;
  describe.mutable_source()->set_name("thorax");
  describe.mutable_source()->set_resolution_mm(15);  // compiled fast
  while (Call(v1::SceneService::NewStub(server_->NewChannel()), &v1::SceneService::Stub::DescribeScene, describe)
             .error_code() == grpc::DEADLINE_EXCEEDED) {
    continue;  // the scene is still being compiled
  }
  v1::CheckPhysiologyRequest check;
  *check.mutable_source() = describe.source();
  OpenStreams streams(server_->NewChannel());
  for (int i = 0; i < 120; ++i) {
    streams.Open("/phrenic.v1.StudyService/CheckPhysiology", check.SerializeAsString());
  }
  EXPECT_TRUE(List().ok());
  EXPECT_TRUE(Create().ok());
}

TEST_F(Calls, WatchesOfOneAccountBlockNoOther) {
  StartGuarded();
  v1::CreateStudyRequest study;
  study.set_study_id("long");
  study.mutable_source()->set_name("sheet-2d");
  study.mutable_error()->set_seconds(120);
  study.mutable_error()->set_levels(16);
  const auto create = [&](const std::string& name) {
    return Call(v1::StudyService::NewStub(server_->NewChannel()), &v1::StudyService::Stub::CreateStudy, study, name);
  };
  ASSERT_TRUE(create("greedy").ok());
  v1::WatchStudyRequest watch;
  watch.set_study_id("long");
  OpenStreams streams(server_->NewChannel());
  for (int i = 0; i < 120; ++i) {
    streams.Open("/phrenic.v1.StudyService/WatchStudy", watch.SerializeAsString(), tokens_.at("greedy"));
  }
  EXPECT_TRUE(List("modest").ok());
  study.set_study_id("mine");
  ASSERT_TRUE(create("modest").ok());
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(kPatience));
  context.AddMetadata("authorization", "Bearer " + tokens_.at("modest"));
  watch.set_study_id("mine");
  const auto stub = v1::StudyService::NewStub(server_->NewChannel());
  const auto reader = stub->WatchStudy(&context, watch);
  v1::WatchStudyResponse seen;
  EXPECT_TRUE(reader->Read(&seen)) << reader->Finish().error_message();
  context.TryCancel();
}

// The vertices of this block are 0.4 MB of state, so that each reply has a place of its own and none fits the windows.
TEST_F(Calls, AStateThatCannotBeSentIsNeitherReadNorStepped) {
  StartGuarded();
  const auto stub = v1::SessionService::NewStub(server_->NewChannel());
  v1::CreateSessionRequest create;
  create.set_session_id("block");
  ASSERT_TRUE(google::protobuf::TextFormat::ParseFromString(
      "name: 'block' bodies { name: 'block' role: ROLE_DEFORMABLE block { size { x: 1 y: 1 z: 1 } columns: 19 "
      "rows: 19 layers: 19 } }",
      create.mutable_source()->mutable_scene()));
  const grpc::Status created = Call(stub, &v1::SessionService::Stub::CreateSession, create, "greedy");
  ASSERT_TRUE(created.ok()) << created.error_message();
  v1::GetStateRequest get;
  get.set_session_id("block");
  get.add_read(v1::STATE_PART_POSITIONS);
  get.add_read(v1::STATE_PART_VELOCITIES);
  const std::string message = get.SerializeAsString();
  const std::string headers = http2::HeaderBlock(
      http2::CallHeaders("/phrenic.v1.SessionService/GetState", {{"authorization", "Bearer " + tokens_.at("greedy")}}));
  RawSocket unread(server_->port());
  unread.Send(std::string(http2::kPreface) + http2::Frame(http2::FrameType::kSettings, 0, 0, "") +
              http2::Frame(http2::FrameType::kSettings, http2::kAck, 0, ""));
  for (std::uint32_t stream = 1; stream < 2 * 80; stream += 2) {
    unread.Send(
        http2::Frame(http2::FrameType::kHeaders, http2::kEndHeaders, stream, headers) +
        http2::Frame(http2::FrameType::kData, http2::kEndStream, stream, http2::GrpcPrefix(message.size()) + message));
  }
  v1::StepSessionRequest step;
  step.set_session_id("block");
  step.set_ticks(1);
  *step.mutable_read() = get.read();
  grpc::Status refused;
  const absl::Time last = absl::Now() + absl::Seconds(kPatience);
  while (refused.ok() && absl::Now() < last) {
    refused = Call(stub, &v1::SessionService::Stub::GetState, get, "greedy");
  }
  EXPECT_EQ(refused.error_code(), grpc::RESOURCE_EXHAUSTED) << refused.error_message();
  EXPECT_THAT(refused.error_message(), HasSubstr("large replies"));
  EXPECT_EQ(Call(stub, &v1::SessionService::Stub::StepSession, step, "greedy").error_code(), grpc::RESOURCE_EXHAUSTED);
  step.clear_read();
  step.set_expected_tick(0);
  const grpc::Status stepped = Call(stub, &v1::SessionService::Stub::StepSession, step, "greedy");
  EXPECT_TRUE(stepped.ok()) << stepped.error_message() << ": a step was taken whose state could not be sent";
  get.clear_read();
  EXPECT_TRUE(Call(stub, &v1::SessionService::Stub::GetState, get, "greedy").ok());
}

TEST_F(Calls, CallersWithoutAccountBlockNoAccount) {
  StartGuarded();
  OpenStreams streams(server_->NewChannel());
  for (int i = 0; i < 60; ++i) streams.Open("/grpc.health.v1.Health/Watch", "");
  for (int i = 0; i < 60; ++i) streams.Open(kReflection, "");
  EXPECT_TRUE(List("modest").ok());
  EXPECT_TRUE(Call(v1::ServerService::NewStub(server_->NewChannel()), &v1::ServerService::Stub::GetServer,
                   v1::GetServerRequest())
                  .ok());
}

TEST_F(Calls, TooManyInFlightAreRefusedWithTheSetting) {
  Start({"--max-calls", "16"});
  ASSERT_TRUE(Create().ok());
  v1::WatchFramesRequest watch;
  watch.set_session_id("cube-springs");
  const auto channel = server_->NewChannel();
  OpenStreams streams(channel);
  for (int i = 0; i < 16; ++i) streams.OpenAndRead("/phrenic.v1.FrameService/WatchFrames", watch.SerializeAsString());
  const grpc::Status refused =
      Call(v1::SessionService::NewStub(channel), &v1::SessionService::Stub::ListSessions, v1::ListSessionsRequest());
  EXPECT_EQ(refused.error_code(), grpc::RESOURCE_EXHAUSTED);
  EXPECT_THAT(refused.error_message(), HasSubstr("--max-calls"));
  EXPECT_TRUE(List().ok());
}

// Four connections have all calls that the server allows in flight.
TEST_F(Calls, ReadinessFailsWhileCallsDoNotGetThrough) {
  Start({"--max-calls", "16"});
  ASSERT_TRUE(Create().ok());
  ASSERT_TRUE(Ready());
  {
    v1::WatchFramesRequest watch;
    watch.set_session_id("cube-springs");
    std::vector<std::unique_ptr<OpenStreams>> connections;
    for (int i = 0; i < 4; ++i) {
      connections.push_back(std::make_unique<OpenStreams>(server_->NewChannel()));
      for (int j = 0; j < 16; ++j) {
        connections.back()->OpenAndRead("/phrenic.v1.FrameService/WatchFrames", watch.SerializeAsString());
      }
    }
    EXPECT_TRUE(AwaitReady(false));
  }
  EXPECT_TRUE(AwaitReady(true)) << "it does not recover";
}

TEST_F(Calls, ARequestThatDoesNotEndTimesOut) {
  Start({"--idle-seconds", "1"});
  RawHttp2 client(server_->port());
  const std::uint32_t stream = client.Begin("/phrenic.v1.SessionService/ListSessions");
  client.SendPart(stream, 1000, 10);
  const absl::Time start = absl::Now();
  EXPECT_TRUE(client.AwaitEnd(stream));
  EXPECT_GT(absl::Now() - start, absl::Milliseconds(900));
}

TEST_F(Calls, UnfinishedRequestsBlockNoOtherAndHoldLittleMemory) {
  Start();
  const std::int64_t before = server_->Memory();
  std::vector<std::unique_ptr<RawHttp2>> clients;
  for (int i = 0; i < 8; ++i) {
    clients.push_back(std::make_unique<RawHttp2>(server_->port()));
    for (int j = 0; j < 100; ++j) {
      const std::uint32_t stream = clients.back()->Begin("/phrenic.v1.UploadService/AddUploadChunk");
      clients.back()->SendPart(stream, (16 << 20) - 1, 500);
    }
  }
  EXPECT_TRUE(List().ok());
  EXPECT_LT(server_->Memory() - before, 64 << 20);
}

TEST_F(Calls, WithoutAccountNoRequestIsRead) {
  StartGuarded();
  for (const char* method : {"/phrenic.v1.SessionService/CreateSession", "/phrenic.v1.ServerService/GetServer",
                             "/grpc.health.v1.Health/Check", kReflection}) {
    RawHttp2 client(server_->port());
    const std::uint32_t stream = client.Begin(method);
    client.SendPart(stream, (16 << 20) - 1, 10);
    EXPECT_TRUE(client.AwaitEnd(stream)) << method;
  }
}

// Returns the status of an empty request to any method.
grpc::Status EmptyCall(const std::shared_ptr<grpc::Channel>& channel, const std::string& method,
                       const std::string& message = "", grpc::ByteBuffer* response = nullptr) {
  grpc::GenericStub stub(channel);
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(kPatience));
  grpc::CompletionQueue queue;
  grpc::ByteBuffer unused;
  grpc::Status status;
  const auto call = stub.PrepareUnaryCall(&context, method, Bytes(message), &queue);
  call->StartCall();
  call->Finish(response == nullptr ? &unused : response, &status, nullptr);
  void* tag = nullptr;
  bool ok = false;
  queue.Next(&tag, &ok);
  return status;
}

TEST_F(Calls, EveryMethodHasAHandler) {
  Start();
  std::set<std::string> services;
  for (const access::Rule& rule : access::Rules()) services.emplace(rule.method.substr(0, rule.method.find('.')));
  int methods = 0;
  for (const std::string& name : services) {
    const auto* service = google::protobuf::DescriptorPool::generated_pool()->FindServiceByName("phrenic.v1." + name);
    ASSERT_NE(service, nullptr) << name;
    for (int i = 0; i < service->method_count(); ++i, ++methods) {
      const std::string path = absl::StrCat("/phrenic.v1.", name, "/", service->method(i)->name());
      EXPECT_NE(EmptyCall(server_->NewChannel(), path).error_code(), grpc::UNIMPLEMENTED) << path;
    }
  }
  EXPECT_EQ(methods, static_cast<int>(access::Rules().size()));
  EXPECT_EQ(EmptyCall(server_->NewChannel(), "/phrenic.v1.ServerService/Nonsense").error_code(), grpc::UNIMPLEMENTED);
}

TEST_F(Calls, AMessageOfAnotherTypeIsRefused) {
  Start();
  const grpc::Status status = EmptyCall(server_->NewChannel(), "/phrenic.v1.SessionService/GetSession", "\xff\xff");
  EXPECT_EQ(status.error_code(), grpc::INVALID_ARGUMENT);
  EXPECT_THAT(status.error_message(), HasSubstr("phrenic.v1.GetSessionRequest"));
}

TEST_F(Calls, ReflectionNeedsAnAccount) {
  StartGuarded();
  EXPECT_EQ(EmptyCall(server_->NewChannel(), kReflection, std::string("\x3a\x01*", 3)).error_code(),
            grpc::UNAUTHENTICATED);
}

TEST_F(Calls, ReflectionTellsServicesAndFiles) {
  Start();
  for (const std::string package : {"v1", "v1alpha"}) {
    const std::string method = "/grpc.reflection." + package + ".ServerReflection/ServerReflectionInfo";
    grpc::ByteBuffer response;
    ASSERT_TRUE(EmptyCall(server_->NewChannel(), method, std::string("\x3a\x01*", 3), &response).ok());
    EXPECT_THAT(Text(response), HasSubstr("phrenic.v1.SessionService"));
    const std::string symbol = "phrenic.v1.SessionService";
    const std::string ask = "\x22" + std::string(1, static_cast<char>(symbol.size())) + symbol;
    ASSERT_TRUE(EmptyCall(server_->NewChannel(), method, ask, &response).ok());
    EXPECT_THAT(Text(response), HasSubstr("phrenic/v1/scene.proto")) << "imported files";
    ASSERT_TRUE(EmptyCall(server_->NewChannel(), method, std::string("\x22\x01?", 3), &response).ok());
    EXPECT_THAT(Text(response), HasSubstr("there is no such symbol"));
  }
}

}  // namespace
}  // namespace phrenic::service
