#include "server/service/server.h"

#include <grpcpp/generic/generic_stub.h>
#include <openssl/sha.h>

#include "absl/strings/escaping.h"
#include "absl/time/clock.h"
#include "server/service/address.h"
#include "tests/service/server_fixture.h"

namespace phrenic::service {
namespace {

using testing::HasSubstr;

class ServerTest : public ServerFixture {};

TEST_F(ServerTest, APortInUseIsAnErrorThatNamesIt) {
  ServerOptions grpc_taken, web_taken;
  grpc_taken.listen = absl::StrCat("127.0.0.1:", server_->port());
  web_taken.web = absl::StrCat("127.0.0.1:", server_->web_port());
  for (const auto& [options, address] : {std::pair(grpc_taken, grpc_taken.listen), {web_taken, web_taken.web}}) {
    const auto second = Server::Start(options);
    EXPECT_TRUE(absl::IsUnavailable(second.status())) << second.status();
    EXPECT_THAT(std::string(second.status().message()), HasSubstr("cannot listen on " + address));
  }
}

TEST_F(ServerTest, AnAddressThatIsNoneOrAFolderThatIsMissingIsAnError) {
  for (const char* bad : {"nonsense", "127.0.0.1", ":80", "127.0.0.1:99999", "::1:80", "127.0.0.1:http"}) {
    ServerOptions options;
    options.listen = bad;
    EXPECT_TRUE(absl::IsInvalidArgument(Server::Start(options).status())) << bad;
    options.listen.clear();
    options.web = bad;
    EXPECT_TRUE(absl::IsInvalidArgument(Server::Start(options).status())) << bad;
  }
  ServerOptions options;
  options.data_dir = "/nowhere";
  EXPECT_TRUE(absl::IsNotFound(Server::Start(options).status()));
}

TEST(Address, HostsAreNamesOrNumbersAndBracketsGo) {
  EXPECT_EQ(ParseAddress("[::1]:8080")->host, "::1");
  EXPECT_EQ(ParseAddress("localhost:0")->port, 0);
  EXPECT_TRUE(IsLoopback(*ParseAddress("127.0.0.1:1")));
  EXPECT_FALSE(IsLoopback(*ParseAddress("0.0.0.0:1")));
}

TEST_F(ServerTest, WithoutAnySocketItServesInProcess) {
  const auto server = Server::Start({});
  ASSERT_TRUE(server.ok()) << server.status();
  EXPECT_EQ((*server)->port(), 0);
  const auto stub = v1::SessionService::NewStub((*server)->InProcessChannel());
  v1::CreateSessionRequest request;
  request.mutable_source()->set_name("cube-springs");
  v1::CreateSessionResponse response;
  grpc::ClientContext context;
  const grpc::Status status = stub->CreateSession(&context, request, &response);
  EXPECT_TRUE(status.ok()) << status.error_message();
  EXPECT_EQ(response.session().id(), "cube-springs");
}

TEST_F(ServerTest, ShutdownEndsPlayingSessionsViewersAndStepsWithinSeconds) {
  CreateCube("cube");
  CreateCube("other");
  v1::PlaySessionResponse played;
  ASSERT_TRUE(Call(*sessions_, &v1::SessionService::Stub::PlaySession, "session_id: 'cube'", &played).ok());
  Watch watch(channel_, "cube");
  v1::WatchFramesResponse response;
  ASSERT_TRUE(watch.Read(&response));
  const absl::Time start = absl::Now();
  server_->Shutdown();
  server_->Shutdown();
  EXPECT_LT(absl::Now() - start, absl::Seconds(3));
  while (watch.Read(&response)) continue;
  EXPECT_EQ(watch.Finish().error_code(), grpc::UNAVAILABLE);
}

// Health checking and reflection by their wire, which is fixed: neither has a stub here.
TEST_F(ServerTest, HealthIsServing) {
  grpc::GenericStub stub(channel_);
  grpc::ClientContext context;
  grpc::CompletionQueue queue;
  grpc::ByteBuffer response;
  grpc::Status status;
  const grpc::Slice empty;
  const grpc::ByteBuffer request(&empty, 1);
  const auto call = stub.PrepareUnaryCall(&context, "/grpc.health.v1.Health/Check", request, &queue);
  call->StartCall();
  call->Finish(&response, &status, this);
  void* tag = nullptr;
  bool ok = false;
  ASSERT_TRUE(queue.Next(&tag, &ok));
  ASSERT_TRUE(status.ok()) << status.error_message();
  std::vector<grpc::Slice> slices;
  response.Dump(&slices);
  ASSERT_EQ(slices.size(), 1u);
  EXPECT_EQ(std::string(slices[0].begin(), slices[0].end()), std::string("\x08\x01", 2)) << "not SERVING";
}

class ExportTest : public ServerFixture {
 protected:
  grpc::Status Export(const std::string& text, std::string* file, v1::ExportSummary* summary) {
    v1::ExportMotionRequest request;
    EXPECT_TRUE(google::protobuf::TextFormat::ParseFromString(text, &request));
    grpc::ClientContext context;
    const auto reader = exports_->ExportMotion(&context, request);
    v1::ExportMotionResponse response;
    while (reader->Read(&response)) {
      *file += response.chunk();
      if (response.has_summary()) *summary = response.summary();
    }
    return reader->Finish();
  }
};

TEST_F(ExportTest, TheFileThatArrivesIsTheOneInTheSummary) {
  CreateCube("cube");
  v1::ListFormatsResponse formats;
  ASSERT_TRUE(Call(*exports_, &v1::ExportService::Stub::ListFormats, "", &formats).ok());
  ASSERT_GE(formats.formats_size(), 2);
  for (const v1::FileFormat& format : formats.formats()) {
    std::string file;
    v1::ExportSummary summary;
    const grpc::Status status =
        Export(absl::StrCat("session_id: 'cube' format: '", format.name(), "' seconds: 2"), &file, &summary);
    ASSERT_TRUE(status.ok()) << status.error_message();
    unsigned char digest[SHA256_DIGEST_LENGTH];
    SHA256(reinterpret_cast<const unsigned char*>(file.data()), file.size(), digest);
    EXPECT_EQ(summary.sha256(),
              absl::BytesToHexString(absl::string_view(reinterpret_cast<const char*>(digest), sizeof digest)));
    EXPECT_EQ(summary.frames(), 21);
  }
  v1::GetSessionResponse got;
  ASSERT_TRUE(Call(*sessions_, &v1::SessionService::Stub::GetSession, "session_id: 'cube'", &got).ok());
  EXPECT_EQ(got.session().tick(), 0) << "the session itself went on";
}

TEST_F(ExportTest, AnUnknownFormatIsRefusedAndTheOthersAreNamed) {
  CreateCube("cube");
  std::string file;
  v1::ExportSummary summary;
  const grpc::Status status = Export("session_id: 'cube' format: 'avi' seconds: 1", &file, &summary);
  EXPECT_EQ(status.error_code(), grpc::INVALID_ARGUMENT);
  EXPECT_THAT(status.error_message(), HasSubstr("msh"));
  EXPECT_EQ(Export("session_id: 'cube' format: 'msh' seconds: 1e9", &file, &summary).error_code(),
            grpc::INVALID_ARGUMENT);
}

TEST_F(ExportTest, ExportsThatAreGivenUpMakeRoomForOthers) {
  CreateCube("cube");
  v1::ExportMotionRequest endless;
  endless.set_session_id("cube");
  endless.set_format("msh");
  endless.set_seconds(3600);
  endless.set_frames_per_second(1000);
  v1::ExportMotionResponse response;
  std::string file;
  v1::ExportSummary summary;
  const std::string small = "session_id: 'cube' format: 'msh' seconds: 0.1";
  {
    grpc::ClientContext a, b;
    const auto first = exports_->ExportMotion(&a, endless), second = exports_->ExportMotion(&b, endless);
    ASSERT_TRUE(first->Read(&response));
    ASSERT_TRUE(second->Read(&response));
    EXPECT_EQ(Export(small, &file, &summary).error_code(), grpc::RESOURCE_EXHAUSTED);
    a.TryCancel();
    b.TryCancel();
    first->Finish();
    second->Finish();
  }
  bool room = false;
  for (int i = 0; i < 250 && !room; ++i) {
    room = Export(small, &file, &summary).ok();
    if (!room) absl::SleepFor(absl::Milliseconds(20));
  }
  EXPECT_TRUE(room) << "an export goes on with nobody to receive it";
}

}  // namespace
}  // namespace phrenic::service
