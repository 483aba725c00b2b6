// Callers above a limit are refused with the name of its setting, and do not affect other callers.
#include "tests/service/process_fixture.h"
#include "tests/support/raw_socket.h"
// After Boost, which needs <utility> first.
#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <zlib.h>

#include <filesystem>
#include <thread>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "phrenic/v1/session.grpc.pb.h"
#include "phrenic/v1/upload.grpc.pb.h"

namespace phrenic::service {
namespace {

using testing::HasSubstr;

// Within this time a loaded server must answer [s].
#ifdef PHRENIC_SANITIZED
constexpr int kAnswerTime = 30;
#else
constexpr int kAnswerTime = 10;
#endif

class Limits : public ProcessFixture {
 protected:
  // Returns how long a well-behaved client waits for its response; nullopt if it gets none.
  std::optional<absl::Duration> WebAnswer() const {
    const absl::Time start = absl::Now();
    RawSocket socket(server_->web_port());
    const auto response = socket.Ask("GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n");
    if (!response.has_value() || response->result() != http::status::ok) return std::nullopt;
    return absl::Now() - start;
  }
  grpc::Status GrpcAnswer() const {
    const auto stub = v1::SessionService::NewStub(server_->NewChannel());
    grpc::ClientContext context;
    context.set_wait_for_ready(true);
    context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(kAnswerTime));
    v1::ListSessionsResponse response;
    return stub->ListSessions(&context, {}, &response);
  }
};

TEST_F(Limits, ASlowHeaderTimesOutAlthoughEachByteIsInTime) {
  Start({"--head-seconds", "1"});
  RawSocket slow(server_->web_port());
  slow.Send("GET / HTTP/1.1\r\nHost: localhost\r\n");
  const absl::Time start = absl::Now();
  bool open = true;
  while (open && absl::Now() - start < absl::Seconds(8)) {
    open = slow.Send("X-A: b\r\n");
    absl::SleepFor(absl::Milliseconds(100));
  }
  EXPECT_FALSE(open);
  EXPECT_LT(absl::Now() - start, absl::Seconds(4));
}

TEST_F(Limits, SlowHeadersOnAllConnectionsBlockNoOther) {
  Start({"--head-seconds", "60", "--max-connections", "16"});
  std::vector<std::unique_ptr<RawSocket>> slow;
  for (int i = 0; i < 64; ++i) {
    slow.push_back(std::make_unique<RawSocket>(server_->web_port()));
    slow.back()->Send("GET / HTTP/1.1\r\nX-A");
    if (i % 8 == 7) {
      EXPECT_TRUE(WebAnswer().has_value()) << i;
    }
  }
}

TEST_F(Limits, AnEndlessBodyIsRefusedWithTheLimit) {
  Start({"--max-message-mb", "1"});
  const std::int64_t before = server_->PeakMemory();
  RawSocket socket(server_->web_port());
  socket.Send(
      "POST /phrenic.v1.UploadService/AddUploadChunk HTTP/1.1\r\nHost: localhost\r\nContent-Type: "
      "application/grpc-web+proto\r\n"
      "Transfer-Encoding: chunked\r\n\r\n");
  const std::string chunk = "10000\r\n" + std::string(0x10000, 'x') + "\r\n";
  int sent = 0;
  while (sent < 4096 && socket.Send(chunk)) ++sent;
  EXPECT_LT(sent, 4096) << "256 MiB were accepted";
  EXPECT_LT(server_->PeakMemory() - before, 100 << 20);
  EXPECT_TRUE(WebAnswer().has_value());
}

TEST_F(Limits, AMessageThatIsTooLongIsRefused) {
  Start({"--max-message-mb", "1"});
  const auto stub = v1::UploadService::NewStub(server_->NewChannel());
  v1::AddUploadChunkRequest request;
  request.set_upload_id("u1");
  request.set_chunk(std::string(2 << 20, 'x'));
  v1::AddUploadChunkResponse response;
  grpc::ClientContext context;
  EXPECT_EQ(stub->AddUploadChunk(&context, request, &response).error_code(), grpc::RESOURCE_EXHAUSTED);
  EXPECT_TRUE(GrpcAnswer().ok());
}

// 256 MiB of zeros in 256 kB: gRPC would check the size only after decompression.
TEST_F(Limits, ACompressedMessageIsNotDecompressed) {
  Start();
  const std::int64_t before = server_->PeakMemory();
  const auto stub = v1::UploadService::NewStub(server_->NewChannel());
  v1::AddUploadChunkRequest request;
  request.set_upload_id("u1");
  request.set_chunk(std::string(std::size_t{256} << 20, '\0'));
  v1::AddUploadChunkResponse response;
  for (const auto algorithm : {GRPC_COMPRESS_GZIP, GRPC_COMPRESS_DEFLATE}) {
    grpc::ClientContext context;
    context.set_compression_algorithm(algorithm);
    EXPECT_FALSE(stub->AddUploadChunk(&context, request, &response).ok());
  }
  EXPECT_LT(server_->PeakMemory() - before, 64 << 20) << "the message was decompressed";
  EXPECT_TRUE(GrpcAnswer().ok());
}

// A surface file whose compressed array claims 64 GiB, and one that contains 1 GiB of zeros.
TEST_F(Limits, AnUploadThatExpandsBeyondTheLimitIsRefused) {
  Start();
  const auto stub = v1::UploadService::NewStub(server_->NewChannel());
  const std::int64_t before = server_->PeakMemory();
  std::string packed(1 << 21, '\0');
  uLongf size = packed.size();
  const std::string zeros(std::size_t{1} << 30, '\0');
  ASSERT_EQ(compress2(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(zeros.data()),
                      zeros.size(), 9),
            Z_OK);
  packed.resize(size);
  for (const std::uint64_t claimed : {std::uint64_t{1} << 30, std::uint64_t{1} << 36}) {
    const std::uint64_t header[] = {1, claimed, 0, packed.size()};
    const std::string file = absl::StrCat(
        "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\" "
        "compressor=\"vtkZLibDataCompressor\"><PolyData><Piece NumberOfPoints=\"3\" NumberOfPolys=\"1\"><Points>"
        "<DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"binary\">",
        absl::Base64Escape(absl::string_view(reinterpret_cast<const char*>(header), sizeof header)),
        absl::Base64Escape(packed), "</DataArray></Points></Piece></PolyData></VTKFile>");
    v1::BeginUploadRequest begin;
    begin.set_name("bomb.vtp");
    begin.set_size(static_cast<std::int64_t>(file.size()));
    v1::BeginUploadResponse begun;
    grpc::ClientContext first, second, third;
    ASSERT_TRUE(stub->BeginUpload(&first, begin, &begun).ok());
    v1::AddUploadChunkRequest add;
    add.set_upload_id(begun.upload_id());
    add.set_chunk(file);
    v1::AddUploadChunkResponse added;
    ASSERT_TRUE(stub->AddUploadChunk(&second, add, &added).ok());
    v1::FinishUploadRequest finish;
    finish.set_upload_id(begun.upload_id());
    v1::FinishUploadResponse finished;
    const grpc::Status status = stub->FinishUpload(&third, finish, &finished);
    EXPECT_EQ(status.error_code(), grpc::INVALID_ARGUMENT);
    EXPECT_THAT(status.error_message(), HasSubstr("declares an uncompressed size above"));
  }
  EXPECT_LT(server_->PeakMemory() - before, 128 << 20);
}

// Idle connections, up to this process' limit on open files.
class Connections {
 public:
  Connections(int port, int count) {
    rlimit files{};
    getrlimit(RLIMIT_NOFILE, &files);
    files.rlim_cur = files.rlim_max;
    setrlimit(RLIMIT_NOFILE, &files);
    sockaddr_in place{};
    place.sin_family = AF_INET;
    place.sin_port = htons(static_cast<std::uint16_t>(port));
    place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    for (int i = 0; i < count; ++i) {
      const int file = socket(AF_INET, SOCK_STREAM, 0);
      if (file < 0) break;
      if (connect(file, reinterpret_cast<const sockaddr*>(&place), sizeof place) == 0) {
        files_.push_back(file);
      } else {
        close(file);
      }
    }
  }
  ~Connections() {
    for (const int file : files_) close(file);
  }
  Connections(const Connections&) = delete;
  Connections& operator=(const Connections&) = delete;
  std::size_t size() const { return files_.size(); }

 private:
  std::vector<int> files_;
};

TEST_F(Limits, TenThousandConnectionsToEachPortBlockNoOther) {
  Start();
  const std::int64_t before = server_->PeakMemory();
  {
    const Connections web(server_->web_port(), 10'000);
    EXPECT_GE(web.size(), 9'000u) << "ulimit -n is too low for this test";
    for (int i = 0; i < 5; ++i) {
      const auto waited = WebAnswer();
      ASSERT_TRUE(waited.has_value());
      EXPECT_LT(*waited, absl::Seconds(5));
    }
  }
  { const Connections grpc(server_->port(), 10'000); }
  const grpc::Status after = GrpcAnswer();
  EXPECT_TRUE(after.ok()) << after.error_message();
  EXPECT_LT(server_->PeakMemory() - before, 256 << 20);
}

TEST_F(Limits, ASessionUsesNoMoreThanItsFractionOfACore) {
  Start({"--session-cpu", "0.1"});
  const auto sessions = v1::SessionService::NewStub(server_->NewChannel());
  v1::CreateSessionRequest create;
  create.set_session_id("greedy");
  create.mutable_source()->set_name("cube-springs");
  v1::CreateSessionResponse created;
  grpc::ClientContext creating, playing;
  ASSERT_TRUE(sessions->CreateSession(&creating, create, &created).ok());
  v1::PlaySessionRequest play;
  play.set_session_id("greedy");
  play.set_as_fast_as_possible(true);
  v1::PlaySessionResponse played;
  ASSERT_TRUE(sessions->PlaySession(&playing, play, &played).ok());
  const absl::Time start = absl::Now();
  const double before = server_->Cpu("stepping");
  absl::SleepFor(absl::Seconds(2));
  const double share = (server_->Cpu("stepping") - before) / absl::ToDoubleSeconds(absl::Now() - start);
  EXPECT_LT(share, 0.15);
  EXPECT_GT(share, 0.01) << "the session does not play";
}

TEST_F(Limits, ASilentConnectionIsClosed) {
  Start({"--idle-seconds", "1", "--head-seconds", "1"});
  RawSocket fresh(server_->web_port()), kept(server_->web_port());
  ASSERT_TRUE(kept.Ask("GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n").has_value());
  const absl::Time start = absl::Now();
  EXPECT_EQ(fresh.ReadSome(1), "");
  EXPECT_EQ(kept.ReadSome(1), "");
  EXPECT_LT(absl::Now() - start, absl::Seconds(6));
}

TEST_F(Limits, EachHasASettingThatItsErrorNames) {
  Start({"--max-sessions", "1", "--max-vertices", "10", "--max-upload-mb", "1"});
  const auto sessions = v1::SessionService::NewStub(server_->NewChannel());
  const auto create = [&](const char* scene) {
    v1::CreateSessionRequest request;
    request.mutable_source()->set_name(scene);
    v1::CreateSessionResponse response;
    grpc::ClientContext context;
    return sessions->CreateSession(&context, request, &response);
  };
  EXPECT_THAT(create("sheet-2d").error_message(), HasSubstr("--max-vertices"));
  ASSERT_TRUE(create("cube-springs").ok());
  const grpc::Status second = create("cube-springs");
  EXPECT_EQ(second.error_code(), grpc::RESOURCE_EXHAUSTED);
  EXPECT_THAT(second.error_message(), HasSubstr("--max-sessions"));
  const auto uploads = v1::UploadService::NewStub(server_->NewChannel());
  v1::BeginUploadRequest begin;
  begin.set_name("large.stl");
  begin.set_size(2 << 20);
  v1::BeginUploadResponse begun;
  grpc::ClientContext context;
  EXPECT_THAT(uploads->BeginUpload(&context, begin, &begun).error_message(), HasSubstr("--max-upload-mb"));
}

}  // namespace
}  // namespace phrenic::service
