// SIGTERM: sessions are saved, streams end with UNAVAILABLE, exports end, and the process exits in time.
#include <gmock/gmock.h>

#include <filesystem>
#include <thread>

#include "phrenic/v1/export.grpc.pb.h"
#include "phrenic/v1/frames.grpc.pb.h"
#include "phrenic/v1/session.grpc.pb.h"
#include "tests/support/server_process.h"

namespace phrenic::service {
namespace {

using testing::HasSubstr;

class StopTest : public testing::Test {
 protected:
  StopTest() : folder_(testing::TempDir() + "/phrenic-stop-" + std::to_string(getpid())) {
    std::filesystem::create_directories(folder_);
  }
  void SetUp() override {
    const absl::Status status = server_.Start();
    ASSERT_TRUE(status.ok()) << status;
  }
  ~StopTest() override {
    server_.Kill();
    std::filesystem::remove_all(folder_);
  }
  template <class Stub, class Request, class Response>
  static void Call(Stub& stub, grpc::Status (Stub::*method)(grpc::ClientContext*, const Request&, Response*),
                   const Request& request, Response* response) {
    grpc::ClientContext context;
    const grpc::Status status = (stub.*method)(&context, request, response);
    ASSERT_TRUE(status.ok()) << status.error_message();
  }
  void CreateAndPlay() {
    const auto sessions = v1::SessionService::NewStub(server_.NewChannel());
    v1::CreateSessionRequest create;
    create.set_session_id("sheet");
    create.mutable_source()->set_name("sheet-2d");
    create.mutable_parameters()->set_time_step(1e-5);  // slow enough to be running at the signal
    v1::CreateSessionResponse created;
    Call(*sessions, &v1::SessionService::Stub::CreateSession, create, &created);
    v1::PlaySessionRequest play;
    play.set_session_id("sheet");
    v1::PlaySessionResponse played;
    Call(*sessions, &v1::SessionService::Stub::PlaySession, play, &played);
  }
  v1::Session Get() {
    const auto sessions = v1::SessionService::NewStub(server_.NewChannel());
    v1::GetSessionRequest get;
    get.set_session_id("sheet");
    v1::GetSessionResponse got;
    Call(*sessions, &v1::SessionService::Stub::GetSession, get, &got);
    return got.session();
  }

  const std::string folder_;
  ServerProcess server_{folder_ + "/said", {"--store", folder_ + "/store", "--stop-seconds", "8"}};
};

TEST_F(StopTest, EndsStreamsAndKeepsTheLastState) {
  CreateAndPlay();
  const auto frames = v1::FrameService::NewStub(server_.NewChannel());
  grpc::ClientContext context;
  v1::WatchFramesRequest watch;
  watch.set_session_id("sheet");
  const auto reader = frames->WatchFrames(&context, watch);
  v1::WatchFramesResponse response;
  std::int64_t seen = 0;
  for (int i = 0; i < 30; ++i) {
    ASSERT_TRUE(reader->Read(&response));
    if (response.has_frame()) seen = response.frame().tick();
  }
  std::thread rest([&] {
    while (reader->Read(&response)) {
      if (response.has_frame()) seen = response.frame().tick();
    }
  });
  EXPECT_EQ(server_.Stop(10), 0) << server_.output();
  rest.join();
  const grpc::Status told = reader->Finish();
  EXPECT_EQ(told.error_code(), grpc::UNAVAILABLE);
  EXPECT_THAT(told.error_message(), HasSubstr("the server is shutting down"));
  ASSERT_TRUE(server_.Start().ok()) << server_.output();
  const v1::Session session = Get();
  EXPECT_GE(session.tick(), seen) << "a tick that was sent to a viewer is lost";
  EXPECT_EQ(session.state(), v1::SESSION_STATE_PLAYING);
}

TEST_F(StopTest, AbortsExportsAndEndsTheirWatchers) {
  CreateAndPlay();
  const auto exports = v1::ExportService::NewStub(server_.NewChannel());
  v1::CreateExportRequest create;
  create.set_export_id("long");
  create.set_session_id("sheet");
  create.set_format("csv");
  create.set_seconds(3600);
  v1::CreateExportResponse created;
  Call(*exports, &v1::ExportService::Stub::CreateExport, create, &created);
  grpc::ClientContext context;
  v1::WatchExportRequest watch;
  watch.set_export_id("long");
  const auto reader = exports->WatchExport(&context, watch);
  v1::WatchExportResponse response;
  ASSERT_TRUE(reader->Read(&response));
  std::thread rest([&] {
    while (reader->Read(&response)) continue;
  });
  const absl::Time start = absl::Now();
  EXPECT_EQ(server_.Stop(10), 0) << server_.output();
  EXPECT_LT(absl::Now() - start, absl::Seconds(5));
  rest.join();
  EXPECT_FALSE(reader->Finish().ok());
}

}  // namespace
}  // namespace phrenic::service
