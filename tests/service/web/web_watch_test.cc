// WatchFrames through the gateway, which takes the messages from the publisher, is the native stream: the same bytes,
// flow control and errors.
#include "tests/support/raw_socket.h"
// After Boost, which needs <utility> first.
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/support/byte_buffer.h>

#include <thread>

#include "absl/strings/escaping.h"
#include "server/service/watch/watch_claims.h"
#include "tests/fake_clock.h"
#include "tests/service/server_fixture.h"

namespace phrenic::service {
namespace {

constexpr char kMethod[] = "/phrenic.v1.FrameService/WatchFrames";

// One WatchFrames stream, message by message as bytes.
class MessageStream {
 public:
  virtual ~MessageStream() = default;
  // Returns the next message; nullopt at the end.
  virtual std::optional<std::string> Next() = 0;
  // Requires: Next has returned nullopt.
  virtual grpc::Status End() = 0;

  std::optional<v1::Frame> NextFrame() {
    v1::WatchFramesResponse response;
    while (const auto message = Next()) {
      if (response.ParseFromString(*message) && response.has_frame()) return response.frame();
    }
    return std::nullopt;
  }
};

class NativeStream final : public MessageStream {
 public:
  NativeStream(const std::shared_ptr<grpc::Channel>& channel, const v1::WatchFramesRequest& request) : stub_(channel) {
    context_.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(30));
    call_ = stub_.PrepareCall(&context_, kMethod, &queue_);
    call_->StartCall(this);
    Wait();
    const grpc::Slice slice(request.SerializeAsString());
    call_->WriteLast(grpc::ByteBuffer(&slice, 1), {}, this);
    Wait();
  }
  ~NativeStream() override {
    context_.TryCancel();
    while (Next().has_value()) continue;
    if (!ended_) End();
  }
  std::optional<std::string> Next() override {
    grpc::ByteBuffer buffer;
    call_->Read(&buffer, this);
    if (!Wait()) return std::nullopt;
    std::vector<grpc::Slice> slices;
    if (!buffer.Dump(&slices).ok()) return std::nullopt;
    std::string bytes;
    for (const grpc::Slice& slice : slices) bytes.append(reinterpret_cast<const char*>(slice.begin()), slice.size());
    return bytes;
  }
  grpc::Status End() override {
    ended_ = true;
    grpc::Status status;
    call_->Finish(&status, this);
    Wait();
    return status;
  }

 private:
  bool Wait() {
    void* tag = nullptr;
    bool ok = false;
    return queue_.Next(&tag, &ok) && ok;
  }

  grpc::GenericStub stub_;
  grpc::ClientContext context_;
  grpc::CompletionQueue queue_;
  std::unique_ptr<grpc::GenericClientAsyncReaderWriter> call_;
  bool ended_ = false;
};

class WebStreamReader final : public MessageStream {
 public:
  WebStreamReader(int port, const v1::WatchFramesRequest& request, bool text) : socket_(port), text_(text) {
    const std::string message = WebMessage(request.SerializeAsString());
    const std::string body = text ? absl::Base64Escape(message) : message;
    socket_.Send(absl::StrCat("POST ", kMethod, " HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/grpc-web",
                              text ? "-text" : "", "\r\nContent-Length: ", body.size(), "\r\n\r\n", body));
  }
  // The frames as they came, each of which must be a chunk of its own.
  std::optional<WebFrame> NextFrameOfBody() {
    if (!headed_) LineUntil("\r\n\r\n");
    headed_ = true;
    const std::string size = LineUntil("\r\n");
    std::string chunk = size.empty() ? "" : socket_.ReadExactly(std::stoul(size, nullptr, 16));
    socket_.ReadExactly(2);
    std::string decoded;
    if (text_ && absl::Base64Unescape(chunk, &decoded)) chunk = decoded;
    bytes_ += chunk.size();
    const auto frames = WebFrames(chunk);
    if (frames.size() != 1 || frames.front().bytes.size() + 5 != chunk.size()) return std::nullopt;
    return frames.front();
  }
  std::optional<std::string> Next() override {
    const auto frame = NextFrameOfBody();
    if (frame.has_value() && frame->flags == 0) return frame->bytes;
    trailers_ = frame.has_value() ? frame->bytes : "";
    return std::nullopt;
  }
  grpc::Status End() override {
    const auto after = [this](const std::string& name) {
      const std::size_t at = trailers_.find(name + ": ");
      if (at == std::string::npos) return std::string();
      return trailers_.substr(at + name.size() + 2, trailers_.find("\r\n", at) - at - name.size() - 2);
    };
    return {static_cast<grpc::StatusCode>(std::stoi("0" + after("grpc-status"))), after("grpc-message")};
  }
  std::size_t bytes() const { return bytes_; }

 private:
  std::string LineUntil(const std::string& end) {
    std::string line;
    while (!line.ends_with(end)) {
      const std::string next = socket_.ReadExactly(1);
      if (next.empty()) return "";
      line += next;
    }
    return line;
  }

  RawSocket socket_;
  const bool text_;
  bool headed_ = false;
  std::string trailers_;
  std::size_t bytes_ = 0;
};

class WebWatchTest : public ServerFixture {
 protected:
  WebWatchTest() { options_.limits.viewers = 16; }
  void SetUp() override {
    ServerFixture::SetUp();
    CreateCube("cube");
  }
  std::unique_ptr<MessageStream> Native(const std::string& request) {
    return std::make_unique<NativeStream>(NewChannel(), RequestOf<v1::WatchFramesRequest>(request));
  }
  std::unique_ptr<WebStreamReader> Web(const std::string& request, bool text = false) {
    return std::make_unique<WebStreamReader>(server_->web_port(), RequestOf<v1::WatchFramesRequest>(request), text);
  }
  bool Step(const std::string& id, int ticks) {
    return Session(&v1::SessionService::Stub::StepSession, absl::StrCat("session_id: '", id, "' ticks: ", ticks)).ok();
  }
  int Viewers(const std::string& id) {
    v1::GetSessionResponse got;
    const std::string request = absl::StrCat("session_id: '", id, "'");
    EXPECT_TRUE(Call(*sessions_, &v1::SessionService::Stub::GetSession, request, &got).ok());
    return got.session().viewers();
  }
};

// One viewer after the other sees a paused session: its status and its newest frame are the same.
TEST_F(WebWatchTest, TheBodyIsTheFramingOfTheNativeMessages) {
  ASSERT_TRUE(Step("cube", 30));
  const auto first_two = [](MessageStream& stream) {
    std::vector<std::string> messages;
    for (int i = 0; i < 2; ++i) messages.push_back(stream.Next().value_or("the stream ended"));
    return messages;
  };
  for (const char* codec : {"CODEC_RAW", "CODEC_PLANES", "CODEC_PREDICTED", "CODEC_BASIS"}) {
    const std::string request = absl::StrCat("session_id: 'cube' codec: ", codec);
    const auto native = first_two(*Native(request));
    ASSERT_TRUE(Eventually([&] { return Viewers("cube") == 0; }));
    for (const bool text : {false, true}) {
      EXPECT_EQ(first_two(*Web(request, text)), native) << codec << (text ? " as text" : "");
      ASSERT_TRUE(Eventually([&] { return Viewers("cube") == 0; }));
    }
  }
}

TEST_F(WebWatchTest, ViewersOfBothWaysGetTheSameBytesOfAFrame) {
  const std::string request = "session_id: 'cube' codec: CODEC_PREDICTED";
  const auto native = Native(request);
  const auto web = Web(request), other = Web(request);
  for (int i = 0; i < 5; ++i) {
    ASSERT_TRUE(Step("cube", 20));
    std::vector<std::string> seen;
    for (MessageStream* stream :
         {native.get(), static_cast<MessageStream*>(web.get()), static_cast<MessageStream*>(other.get())}) {
      std::optional<v1::Frame> frame = stream->NextFrame();
      while (frame.has_value() && frame->tick() < 20 * (i + 1)) frame = stream->NextFrame();
      ASSERT_TRUE(frame.has_value());
      seen.push_back(frame->SerializeAsString());
    }
    EXPECT_EQ(seen[1], seen[0]);
    EXPECT_EQ(seen[2], seen[0]);
  }
}

TEST_F(WebWatchTest, ErrorsAreThoseOfTheNativeStream) {
  const auto holder = Native("session_id: 'cube' watch_id: 'taken'");
  ASSERT_TRUE(holder->Next().has_value());
  for (const char* request :
       {"session_id: 'nothing'", "session_id: 'cube' bodies: 'nothing'", "session_id: 'cube' max_unacked_frames: 2",
        "session_id: 'cube' watch_id: 'taken'", "session_id: 'cube' max_fps: -1", "session_id: 'cube' watch_id: '/'"}) {
    const auto native = Native(request);
    EXPECT_FALSE(native->Next().has_value()) << request;
    const grpc::Status wanted = native->End();
    EXPECT_NE(wanted.error_code(), grpc::OK) << request;
    const auto web = Web(request);
    EXPECT_FALSE(web->Next().has_value()) << request;
    const grpc::Status status = web->End();
    EXPECT_EQ(status.error_code(), wanted.error_code()) << request;
    EXPECT_EQ(status.error_message(), wanted.error_message()) << request;
  }
  EXPECT_EQ(Viewers("cube"), 1) << "a refused viewer is counted";
}

TEST_F(WebWatchTest, AViewerAboveTheLimitIsRefusedUntilAnotherLeaves) {
  std::vector<std::unique_ptr<WebStreamReader>> viewers;
  for (int i = 0; i < 16; ++i) {
    viewers.push_back(Web("session_id: 'cube'"));
    ASSERT_TRUE(viewers.back()->Next().has_value());
  }
  const auto refused = Web("session_id: 'cube'");
  EXPECT_FALSE(refused->Next().has_value());
  EXPECT_EQ(refused->End().error_code(), grpc::RESOURCE_EXHAUSTED);
  viewers.pop_back();
  EXPECT_TRUE(Eventually([&] { return Web("session_id: 'cube'")->Next().has_value(); }));
}

// The server sends no more than max_unacked_frames frames before they are acknowledged.
TEST_F(WebWatchTest, FramesWaitForAcknowledgements) {
  const auto web = Web("session_id: 'cube' codec: CODEC_PREDICTED watch_id: 'page' max_unacked_frames: 2");
  const auto first = web->NextFrame();
  ASSERT_TRUE(first.has_value() && Step("cube", 20));
  auto newest = web->NextFrame();
  ASSERT_TRUE(newest.has_value());
  EXPECT_EQ(newest->sequence(), first->sequence() + 1);
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(Step("cube", 3));
  int frames = 0;
  while (newest->tick() < 80) {
    v1::AckFramesResponse given;
    const std::string ack = absl::StrCat("session_id: 'cube' watch_id: 'page' sequence: ", newest->sequence());
    ASSERT_TRUE(Call(*frames_, &v1::FrameService::Stub::AckFrames, ack, &given).ok());
    newest = web->NextFrame();
    ASSERT_TRUE(newest.has_value());
    ++frames;
  }
  EXPECT_LT(frames, 10) << "frames were sent without credit, instead of the newest";
}

// Acknowledgements of browsers do not go through gRPC; their answers and errors are the same.
TEST_F(WebWatchTest, AnAcknowledgementIsAnsweredAsOverGrpc) {
  const auto web = Web("session_id: 'cube' watch_id: 'page' max_unacked_frames: 2");
  ASSERT_TRUE(web->NextFrame().has_value());
  RawSocket socket(server_->web_port());
  for (const char* text : {"session_id: 'cube' watch_id: 'page' sequence: 1", "session_id: 'cube' watch_id: 'other'",
                           "session_id: 'nothing' watch_id: 'page'", "session_id: 'cube' sequence: -1", ""}) {
    v1::AckFramesResponse wanted, given;
    const grpc::Status status = Call(*frames_, &v1::FrameService::Stub::AckFrames, text, &wanted);
    const std::string body = WebMessage(RequestOf<v1::AckFramesRequest>(text).SerializeAsString());
    const auto response =
        socket.Ask(absl::StrCat("POST /phrenic.v1.FrameService/AckFrames HTTP/1.1\r\nHost: localhost\r\nContent-Type: "
                                "application/grpc-web\r\nContent-Length: ",
                                body.size(), "\r\n\r\n", body));
    ASSERT_TRUE(response.has_value());
    const auto frames = WebFrames(response->body());
    ASSERT_EQ(frames.size(), status.ok() ? 2u : 1u) << text;
    EXPECT_THAT(frames.back().bytes, testing::StartsWith(absl::StrCat("grpc-status: ", status.error_code(), "\r\n")));
    if (!status.ok()) continue;
    ASSERT_TRUE(given.ParseFromString(frames.front().bytes));
    EXPECT_EQ(given.max_unacked_frames(), wanted.max_unacked_frames());
    EXPECT_EQ(given.max_error_mm(), wanted.max_error_mm());
  }
}

// A client that reads nothing costs the messages that fit into the sockets, and the newest afterwards.
TEST_F(WebWatchTest, ASlowReaderSkipsFramesDelaysNoOtherAndGetsTheNewest) {
  constexpr int kFrames = 150;
  v1::CreateSessionResponse created;
  ASSERT_TRUE(Call(*sessions_, &v1::SessionService::Stub::CreateSession, R"(session_id: 'large' source { scene {
      name: "large" bodies { name: "sheet" role: ROLE_DEFORMABLE mass: 1
        grid { columns: 120 rows: 120 u { x: 0.01 } v { y: 0.01 } } }
      forces { springs { bodies: "sheet" stiffness: 1 } } } })",
                   &created)
                  .ok());
  const auto slow = Web("session_id: 'large'"), quick = Web("session_id: 'large'");
  ASSERT_TRUE(slow->Next().has_value());
  std::size_t frame_bytes = 0;
  for (int i = 1; i <= kFrames; ++i) {
    ASSERT_TRUE(Step("large", 1));
    std::optional<v1::Frame> frame = quick->NextFrame();
    while (frame.has_value() && frame->tick() < i) frame = quick->NextFrame();
    ASSERT_TRUE(frame.has_value()) << "the slow viewer delays another";
    frame_bytes += frame->positions().size();
  }
  std::optional<v1::Frame> frame = slow->NextFrame();
  while (frame.has_value() && frame->tick() < kFrames) frame = slow->NextFrame();
  ASSERT_TRUE(frame.has_value()) << "the newest frame was not sent";
  EXPECT_LT(2 * slow->bytes(), frame_bytes) << "frames are queued for a viewer that does not read them";
}

// Stops in the middle of messages, with bytes that wait on both sides.
TEST_F(WebWatchTest, ViewersThatComeAndGoLeaveNothingBehind) {
  ASSERT_TRUE(Session(&v1::SessionService::Stub::PlaySession, "session_id: 'cube' as_fast_as_possible: true").ok());
  for (int round = 0; round < 20; ++round) {
    std::vector<std::unique_ptr<WebStreamReader>> viewers;
    for (int i = 0; i < 4; ++i) viewers.push_back(Web("session_id: 'cube'"));
    for (int i = 0; i < round % 4; ++i) viewers[static_cast<std::size_t>(i)]->Next();
  }
  EXPECT_TRUE(Eventually([&] { return Viewers("cube") == 0; }));
}

TEST(WatchClaims, AClaimIsGivenItsWatchOnceAndNoneAfterItsEnd) {
  WatchClaims claims;
  int given = 0;
  auto claim = claims.Add([&](const std::shared_ptr<ClaimedWatch>&) { ++given; });
  const auto other = claims.Add([&](const std::shared_ptr<ClaimedWatch>&) { FAIL(); });
  EXPECT_NE(claim->key(), other->key());
  EXPECT_FALSE(claims.Give("", nullptr));
  EXPECT_TRUE(claims.Has(claim->key()));
  EXPECT_TRUE(claims.Give(claim->key(), nullptr));
  EXPECT_FALSE(claims.Give(claim->key(), nullptr));
  EXPECT_EQ(given, 1);
  claim = claims.Add([&](const std::shared_ptr<ClaimedWatch>&) { FAIL(); });
  const std::string key = claim->key();
  claim = nullptr;
  EXPECT_FALSE(claims.Has(key));
  EXPECT_FALSE(claims.Give(key, nullptr));
}

// A key of a claim is a secret of the gateway: a client's own has no effect.
TEST_F(WebWatchTest, AClaimOfAClientHasNoEffect) {
  RawSocket socket(server_->web_port());
  const std::string body = WebMessage(RequestOf<v1::WatchFramesRequest>("session_id: 'cube'").SerializeAsString());
  socket.Send(absl::StrCat("POST ", kMethod, " HTTP/1.1\r\nHost: localhost\r\nX-Phrenic-Watch: 0123456789abcdef\r\n",
                           "Content-Type: application/grpc-web\r\nContent-Length: ", body.size(), "\r\n\r\n", body));
  EXPECT_GT(socket.ReadSome(300).size(), 300u);
  grpc::ClientContext context;
  context.AddMetadata("x-phrenic-watch", "0123456789abcdef");
  const auto reader = frames_->WatchFrames(&context, RequestOf<v1::WatchFramesRequest>("session_id: 'cube'"));
  v1::WatchFramesResponse response;
  EXPECT_TRUE(reader->Read(&response));
  context.TryCancel();
  reader->Finish();
}

}  // namespace
}  // namespace phrenic::service
