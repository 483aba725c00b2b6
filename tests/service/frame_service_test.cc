#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/support/byte_buffer.h>

#include <cmath>
#include <cstring>
#include <thread>

#include "tests/service/server_fixture.h"

namespace phrenic::service {
namespace {

using Sessions = v1::SessionService::Stub;

bool IsFrame(const v1::WatchFramesResponse& response) { return response.has_frame(); }

class FrameServiceTest : public ServerFixture {
 protected:
  void SetUp() override {
    ServerFixture::SetUp();
    CreateCube("cube");
  }
};

TEST_F(FrameServiceTest, GeometryHasEveryBodyOnce) {
  v1::GetGeometryRequest request;
  request.set_session_id("cube");
  grpc::ClientContext context;
  const auto reader = frames_->GetGeometry(&context, request);
  v1::GetGeometryResponse body;
  ASSERT_TRUE(reader->Read(&body));
  EXPECT_EQ(body.body_count(), 1);
  EXPECT_EQ(body.rest_positions().size(), 8 * 12u);
  EXPECT_EQ(body.placement(), v1::PLACEMENT_STREAMED);
  EXPECT_FALSE(reader->Read(&body));
  EXPECT_TRUE(reader->Finish().ok());
}

TEST_F(FrameServiceTest, AViewerGetsTheSessionAndThenAFrameAtOnce) {
  Watch watch(channel_, "cube");
  v1::WatchFramesResponse response;
  ASSERT_TRUE(watch.Read(&response));
  EXPECT_EQ(response.session().id(), "cube");
  ASSERT_TRUE(watch.ReadUntil(IsFrame, &response));
  EXPECT_EQ(response.frame().positions().size(), 8 * 12u);
  EXPECT_EQ(response.frame().probes_size(), 1);
}

TEST_F(FrameServiceTest, TwoViewersSeeTheSameFramesAndEachOthersChanges) {
  Watch one(NewChannel(), "cube"), other(NewChannel(), "cube");
  v1::WatchFramesResponse a, b;
  ASSERT_TRUE(one.ReadUntil(IsFrame, &a));
  ASSERT_TRUE(other.ReadUntil(IsFrame, &b));
  for (int i = 0; i < 5; ++i) {
    ASSERT_TRUE(Session(&Sessions::StepSession, "session_id: 'cube' ticks: 20").ok());
    const auto newest = [&](const v1::WatchFramesResponse& response) {
      return response.frame().tick() == 20 * (i + 1);
    };
    ASSERT_TRUE(one.ReadUntil(newest, &a));
    ASSERT_TRUE(other.ReadUntil(newest, &b));
    EXPECT_EQ(a.SerializeAsString(), b.SerializeAsString());
  }
  ASSERT_TRUE(Session(&Sessions::UpdateParameters, "session_id: 'cube' parameters { breath_force: 1.5 }").ok());
  const auto changed = [](const v1::WatchFramesResponse& response) {
    return response.session().parameters().breath_force() == 1.5;
  };
  EXPECT_TRUE(one.ReadUntil(changed, &a));
  EXPECT_TRUE(other.ReadUntil(changed, &b));
}

TEST_F(FrameServiceTest, FramesOfAPlayingSessionAreInOrder) {
  ASSERT_TRUE(Session(&Sessions::PlaySession, "session_id: 'cube'").ok());
  Watch watch(channel_, "cube");
  v1::WatchFramesResponse response;
  std::int64_t last = 0;
  std::string positions;
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(watch.ReadUntil(IsFrame, &response));
    EXPECT_GT(response.frame().sequence(), last);
    EXPECT_NE(response.frame().positions(), positions);
    last = response.frame().sequence();
    positions = response.frame().positions();
  }
}

TEST_F(FrameServiceTest, ASlowViewerSkipsFramesDelaysNoOtherAndGetsTheNewest) {
  Watch slow(NewChannel(), "cube"), quick(NewChannel(), "cube");
  ASSERT_TRUE(Session(&Sessions::PlaySession, "session_id: 'cube' as_fast_as_possible: true until_time: 30").ok());
  const auto paused = [](const v1::WatchFramesResponse& response) {
    return response.session().state() == v1::SESSION_STATE_PAUSED && response.session().tick() > 0;
  };
  v1::WatchFramesResponse response;
  ASSERT_TRUE(quick.ReadUntil(paused, &response));
  const std::int64_t end = response.session().tick();
  const auto last = [&](const v1::WatchFramesResponse& newest) { return newest.frame().tick() == end; };
  ASSERT_TRUE(quick.ReadUntil(last, &response));
  EXPECT_TRUE(slow.ReadUntil(last, &response)) << "the newest frame was not sent";
}

TEST_F(FrameServiceTest, NumbersOnlyOmitsTheArrays) {
  v1::WatchFramesRequest request;
  request.set_session_id("cube");
  request.set_numbers_only(true);
  grpc::ClientContext context;
  const auto reader = frames_->WatchFrames(&context, request);
  v1::WatchFramesResponse response;
  do {
    ASSERT_TRUE(reader->Read(&response));
  } while (!response.has_frame());
  EXPECT_TRUE(response.frame().positions().empty());
  EXPECT_EQ(response.frame().probes_size(), 1);
  context.TryCancel();
  EXPECT_EQ(reader->Finish().error_code(), grpc::CANCELLED);
}

// The server sends no more than max_unacked_frames frames before they are acknowledged.
TEST_F(FrameServiceTest, FramesWaitForAcknowledgements) {
  v1::WatchFramesRequest request;
  request.set_session_id("cube");
  request.set_codec(v1::CODEC_PREDICTED);
  request.set_watch_id("page");
  request.set_max_unacked_frames(2);
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(30));
  const auto reader = frames_->WatchFrames(&context, request);
  const auto next = [&] {
    v1::WatchFramesResponse response;
    while (reader->Read(&response) && !response.has_frame()) continue;
    return response.frame();
  };
  const v1::Frame first = next();
  EXPECT_EQ(first.codec(), v1::CODEC_PREDICTED);
  EXPECT_EQ(first.max_error_mm(), 0.1);
  EXPECT_THAT(first.bodies(), testing::ElementsAre(0));
  const auto step = [&] { return Session(&Sessions::StepSession, "session_id: 'cube' ticks: 20").ok(); };
  ASSERT_TRUE(step());
  v1::Frame newest = next();
  EXPECT_EQ(newest.sequence(), first.sequence() + 1);
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(step());
  v1::AckFramesResponse given;
  while (newest.tick() < 80) {
    const std::string ack = absl::StrCat("session_id: 'cube' watch_id: 'page' sequence: ", newest.sequence());
    ASSERT_TRUE(Call(*frames_, &v1::FrameService::Stub::AckFrames, ack, &given).ok());
    const std::int64_t last = newest.sequence();
    newest = next();
    ASSERT_GT(newest.sequence(), last);
  }
  EXPECT_EQ(given.max_error_mm(), 0.1);
  EXPECT_GT(given.unix_nanos(), first.unix_nanos());
  EXPECT_EQ(newest.tick(), 80);
  const grpc::Status other =
      Call(*frames_, &v1::FrameService::Stub::AckFrames, "session_id: 'cube' watch_id: 'other'", &given);
  EXPECT_EQ(other.error_code(), grpc::NOT_FOUND) << other.error_message();
  context.TryCancel();
  reader->Finish();
}

TEST_F(FrameServiceTest, AnInvalidRequestIsRefusedWithItsField) {
  const auto refusal = [&](const std::string& text) {
    v1::WatchFramesRequest request;
    EXPECT_TRUE(google::protobuf::TextFormat::ParseFromString("session_id: 'cube' " + text, &request));
    grpc::ClientContext context;
    const auto reader = frames_->WatchFrames(&context, request);
    v1::WatchFramesResponse response;
    EXPECT_FALSE(reader->Read(&response)) << text;
    return reader->Finish();
  };
  EXPECT_THAT(refusal("max_unacked_frames: 2").error_message(), testing::HasSubstr("watch_id"));
  EXPECT_THAT(refusal("bodies: 'sphere'").error_message(), testing::HasSubstr("sphere"));
  EXPECT_THAT(refusal("max_error_mm: 0").error_message(), testing::HasSubstr("max_error_mm"));
  EXPECT_THAT(refusal("codec: 77").error_message(), testing::HasSubstr("codec"));
}

TEST_F(FrameServiceTest, DeletingASessionEndsItsViewers) {
  Watch watch(channel_, "cube");
  v1::WatchFramesResponse response;
  ASSERT_TRUE(watch.ReadUntil(IsFrame, &response));
  ASSERT_TRUE(Session(&Sessions::DeleteSession, "session_id: 'cube'").ok());
  while (watch.Read(&response)) continue;
  const grpc::Status status = watch.Finish();
  EXPECT_EQ(status.error_code(), grpc::NOT_FOUND);
  EXPECT_EQ(status.error_message(), "session cube was deleted");
}

TEST_F(FrameServiceTest, ViewersAboveTheLimitAreRefusedUntilOthersLeave) {
  v1::WatchFramesResponse response;
  Watch first(NewChannel(), "cube"), second(NewChannel(), "cube");
  ASSERT_TRUE(first.Read(&response));
  ASSERT_TRUE(second.Read(&response));
  {
    Watch third(NewChannel(), "cube");
    ASSERT_TRUE(third.Read(&response));
    Watch fourth(NewChannel(), "cube");
    EXPECT_FALSE(fourth.Read(&response));
    EXPECT_EQ(fourth.Finish().error_code(), grpc::RESOURCE_EXHAUSTED);
  }
  const auto alone = [](const v1::WatchFramesResponse& news) { return news.session().viewers() == 2; };
  EXPECT_TRUE(first.ReadUntil(alone, &response)) << "a viewer that left is still counted";
}

TEST_F(FrameServiceTest, ADivergedSessionReportsItAndSendsNoNaN) {
  ASSERT_TRUE(
      Session(&Sessions::UpdateParameters, "session_id: 'cube' parameters { time_step: 0.1 elasticity: 100 }").ok());
  Watch watch(channel_, "cube");
  ASSERT_TRUE(Session(&Sessions::PlaySession, "session_id: 'cube' as_fast_as_possible: true").ok());
  v1::WatchFramesResponse response;
  bool diverged = false;
  while (!diverged && watch.Read(&response)) {
    diverged = response.session().state() == v1::SESSION_STATE_DIVERGED;
    const std::string& bytes = response.frame().positions();
    for (std::size_t i = 0; i < bytes.size(); i += sizeof(float)) {
      float value;
      std::memcpy(&value, bytes.data() + i, sizeof value);
      ASSERT_TRUE(std::isfinite(value));
    }
  }
  ASSERT_TRUE(diverged);
  EXPECT_EQ(response.session().divergence().body(), "cube");
  EXPECT_FALSE(response.session().divergence().remedy().empty());
}

TEST_F(FrameServiceTest, BytesThatAreNotARequestAreRefused) {
  grpc::GenericStub stub(channel_);
  const grpc::Slice slice(std::string("\x0a\xff\xff\xff\xff\x0f", 6));
  const grpc::ByteBuffer request(&slice, 1);
  grpc::ClientContext context;
  grpc::CompletionQueue queue;
  grpc::ByteBuffer response;
  grpc::Status status;
  const auto call = stub.PrepareUnaryCall(&context, "/phrenic.v1.FrameService/WatchFrames", request, &queue);
  call->StartCall();
  call->Finish(&response, &status, this);
  void* tag = nullptr;
  bool ok = false;
  ASSERT_TRUE(queue.Next(&tag, &ok));
  EXPECT_EQ(status.error_code(), grpc::INVALID_ARGUMENT) << status.error_message();
}

TEST_F(FrameServiceTest, ForcesAreReadByKindAtAVertexOrOfAKindAtEveryVertex) {
  v1::GetForcesRequest request;
  request.set_session_id("cube");
  request.set_body("cube");
  request.set_vertex(2);
  request.set_kind("springs");
  v1::GetForcesResponse response;
  grpc::ClientContext context;
  const grpc::Status status = frames_->GetForces(&context, request, &response);
  ASSERT_TRUE(status.ok()) << status.error_message();
  ASSERT_EQ(response.forces_size(), response.kinds_size());
  ASSERT_EQ(response.sizes().size(), 8 * sizeof(float));
  EXPECT_EQ(response.kinds(response.kinds_size() - 1), "net");
  for (int i = 0; i < response.kinds_size(); ++i) {
    if (response.kinds(i) != "springs") continue;
    const v1::Vector& force = response.forces(i);
    float size = 0;
    std::memcpy(&size, response.sizes().data() + 2 * sizeof(float), sizeof(float));
    EXPECT_NEAR(size, std::hypot(force.x(), force.y(), force.z()), 1e-6 * size);
  }
}

TEST_F(FrameServiceTest, ForcesOfUnknownNamesAreRefusedWithTheKnownOnes) {
  const auto refusal = [this](const std::string& body, int vertex, const std::string& kind) {
    v1::GetForcesRequest request;
    request.set_session_id("cube");
    request.set_body(body);
    request.set_vertex(vertex);
    request.set_kind(kind);
    v1::GetForcesResponse response;
    grpc::ClientContext context;
    const grpc::Status status = frames_->GetForces(&context, request, &response);
    EXPECT_EQ(status.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
    return status.error_message();
  };
  EXPECT_THAT(refusal("ball", 0, ""), testing::HasSubstr("body: there is no deformable body \"ball\"; there are cube"));
  EXPECT_THAT(refusal("cube", 8, ""), testing::HasSubstr("its vertices are 0 to 7"));
  EXPECT_THAT(refusal("cube", 0, "magic"), testing::HasSubstr("there are springs, "));
}

}  // namespace
}  // namespace phrenic::service
