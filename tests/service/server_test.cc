#include "server/service/server.h"

#include <grpcpp/generic/generic_stub.h>

#include "absl/time/clock.h"
#include "phrenic/v1/upload.grpc.pb.h"
#include "server/crypto/sha256.h"
#include "server/service/net/address.h"
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

TEST_F(ServerTest, ABadAddressOrAMissingFolderIsAnError) {
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

TEST(Address, HostsAreNamesOrNumbersWithoutBrackets) {
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

// Health checking and reflection with hand-written messages, because the tests have no stubs for them.
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
  using Stub = v1::ExportService::Stub;

  grpc::Status Create(const std::string& text, v1::CreateExportResponse* created) {
    return Call(*exports_, &Stub::CreateExport, text, created);
  }

  v1::Export Watch(const std::string& id) {
    grpc::ClientContext context;
    v1::WatchExportRequest request;
    request.set_export_id(id);
    const auto reader = exports_->WatchExport(&context, request);
    v1::WatchExportResponse response;
    while (reader->Read(&response)) continue;
    EXPECT_TRUE(reader->Finish().ok());
    return response.job();
  }

  grpc::Status Download(const std::string& id, std::int64_t offset, std::string* file) {
    grpc::ClientContext context;
    v1::DownloadExportRequest request;
    request.set_export_id(id);
    request.set_offset(offset);
    const auto reader = exports_->DownloadExport(&context, request);
    v1::DownloadExportResponse response;
    while (reader->Read(&response)) *file += response.chunk();
    return reader->Finish();
  }
};

TEST_F(ExportTest, AFileDownloadedInTwoPartsMatchesItsHash) {
  CreateCube("cube");
  v1::ListFormatsResponse formats;
  ASSERT_TRUE(Call(*exports_, &Stub::ListFormats, "", &formats).ok());
  ASSERT_GE(formats.formats_size(), 8);
  for (const v1::FileFormat& format : formats.formats()) {
    if (format.numbers_only()) continue;  // the cube has no probes
    v1::CreateExportResponse created;
    const std::string length = format.instant() ? "0" : "2";
    const grpc::Status status =
        Create(absl::StrCat("session_id: 'cube' format: '", format.name(), "' seconds: ", length), &created);
    ASSERT_TRUE(status.ok()) << status.error_message();
    const v1::Export job = Watch(created.job().id());
    ASSERT_EQ(job.state(), v1::EXPORT_STATE_DONE) << format.name() << job.problem();
    std::string file, rest;
    ASSERT_TRUE(Download(job.id(), 0, &file).ok());
    ASSERT_TRUE(Download(job.id(), job.bytes() / 3, &rest).ok());
    EXPECT_EQ(file.substr(static_cast<std::size_t>(job.bytes() / 3)), rest) << format.name();
    EXPECT_EQ(job.summary().sha256(), Sha256Hex(file));
  }
  v1::GetSessionResponse got;
  ASSERT_TRUE(Call(*sessions_, &v1::SessionService::Stub::GetSession, "session_id: 'cube'", &got).ok());
  EXPECT_EQ(got.session().tick(), 0) << "the export stepped the session itself";
}

TEST_F(ExportTest, ImpossibleExportsAreRefusedAtOnce) {
  CreateCube("cube");
  v1::CreateExportResponse created;
  const grpc::Status status = Create("session_id: 'cube' format: 'avi' seconds: 1", &created);
  EXPECT_EQ(status.error_code(), grpc::INVALID_ARGUMENT);
  EXPECT_THAT(status.error_message(), HasSubstr("msh"));
  EXPECT_EQ(Create("session_id: 'cube' format: 'msh' seconds: 1e9", &created).error_code(), grpc::INVALID_ARGUMENT);
  EXPECT_EQ(Create("session_id: 'nobody' format: 'msh'", &created).error_code(), grpc::NOT_FOUND);
  std::string file;
  EXPECT_EQ(Download("nothing", 0, &file).error_code(), grpc::NOT_FOUND);
  ASSERT_TRUE(Create("session_id: 'cube' format: 'msh'", &created).ok());
  EXPECT_EQ(Download(Watch("cube").id(), 1 << 30, &file).error_code(), grpc::OUT_OF_RANGE);
}

TEST_F(ExportTest, AnExportIsListedWhileItRunsAndGoneWhenItIsDeleted) {
  CreateCube("cube");
  v1::CreateExportResponse created;
  ASSERT_TRUE(Create("session_id: 'cube' format: 'msh' seconds: 3600 frames_per_second: 1000", &created).ok());
  v1::ListExportsResponse list;
  ASSERT_TRUE(Call(*exports_, &Stub::ListExports, "", &list).ok());
  ASSERT_EQ(list.exports_size(), 1);
  std::string file;
  EXPECT_EQ(Download("cube", 0, &file).error_code(), grpc::FAILED_PRECONDITION);
  v1::DeleteExportResponse deleted;
  ASSERT_TRUE(Call(*exports_, &Stub::DeleteExport, "export_id: 'cube'", &deleted).ok());
  ASSERT_TRUE(Call(*exports_, &Stub::ListExports, "", &list).ok());
  EXPECT_EQ(list.exports_size(), 0);
}

TEST_F(ExportTest, AnUploadedSurfaceIsABodyOfAnyScene) {
  const auto uploads = v1::UploadService::NewStub(channel_);
  using Uploads = v1::UploadService::Stub;
  v1::BeginUploadResponse begun;
  const std::string surface = "v 0 0 0\\nv 30 0 0\\nv 0 30 0\\nf 1 2 3\\n";
  ASSERT_TRUE(Call(*uploads, &Uploads::BeginUpload, "name: 'a.obj' size: 34", &begun).ok());
  v1::AddUploadChunkResponse added;
  ASSERT_TRUE(Call(*uploads, &Uploads::AddUploadChunk,
                   absl::StrCat("upload_id: '", begun.upload_id(), "' chunk: '", surface, "'"), &added)
                  .ok());
  v1::FinishUploadResponse finished;
  const grpc::Status status =
      Call(*uploads, &Uploads::FinishUpload, absl::StrCat("upload_id: '", begun.upload_id(), "'"), &finished);
  ASSERT_TRUE(status.ok()) << status.error_message();
  EXPECT_EQ(finished.report().triangles(), 1);
  v1::CreateSessionResponse created;
  const std::string scene = absl::StrCat(
      "source { scene { name: 'own' bodies { name: 'a' role: ROLE_DEFORMABLE "
      "file { path: '",
      finished.file().path(), "' } } } } session_id: 'own'");
  const grpc::Status made = Call(*sessions_, &v1::SessionService::Stub::CreateSession, scene, &created);
  EXPECT_TRUE(made.ok()) << made.error_message();
}

}  // namespace
}  // namespace phrenic::service
