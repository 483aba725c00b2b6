// How much memory requests may take: when they are parsed, and while they wait.
#include <google/protobuf/text_format.h>
#include <gtest/gtest.h>

#include "phrenic/v1/scene.pb.h"
#include "phrenic/v1/session.grpc.pb.h"
#include "phrenic/v1/study.grpc.pb.h"
#include "server/service/calls/messages.h"
#include "server/service/calls/unfolded.h"
#include "tests/service/process_fixture.h"

namespace phrenic::service {
namespace {

constexpr std::size_t kAll = static_cast<std::size_t>(-1);

grpc::ByteBuffer BytesOf(const std::string& text) {
  const grpc::Slice slice(text);
  return grpc::ByteBuffer(&slice, 1);
}

std::string Repeated(const std::string& bytes, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += bytes;
  return all;
}

// Expects that the count is what protobuf itself says of the parsed message, or up to twice as much.
void ExpectCounted(const std::string& bytes, const std::string& what) {
  v1::Scene scene;
  ASSERT_TRUE(scene.ParseFromString(bytes)) << what;
  const std::size_t counted = UnfoldedBytes(BytesOf(bytes), *v1::Scene::descriptor(), kAll);
  const auto used = static_cast<double>(scene.SpaceUsedLong() - v1::Scene().SpaceUsedLong());
  EXPECT_GT(static_cast<double>(counted), 0.8 * used) << what;
  EXPECT_LT(static_cast<double>(counted), 2 * used) << what;
}

v1::Scene Mesh(int vertices, int triangles) {
  v1::Scene scene;
  auto& shape = *scene.add_bodies()->mutable_polyhedron();
  for (int i = 0; i < vertices; ++i) {
    v1::Vector& vertex = *shape.add_vertices();
    vertex.set_x(i + 0.1);
    vertex.set_y(i + 0.2);
    vertex.set_z(i + 0.3);
  }
  for (int i = 0; i < triangles; ++i) {
    v1::IndexTriple& triangle = *shape.add_triangles();
    triangle.set_a(i % vertices);
    triangle.set_b((i + 1) % vertices);
    triangle.set_c((i + 2) % vertices);
  }
  return scene;
}

TEST(UnfoldedBytes, AreThoseOfTheParsedMessage) {
  ExpectCounted(Repeated(std::string("\x2a\x00", 2), 10'000), "empty bodies");
  ExpectCounted(Repeated(std::string("\x22\x00", 2), 10'000), "empty layers");
  ExpectCounted(Repeated("\x22\x22\x0a\x20" + std::string(32, 'x'), 10'000), "layers with long names");
  ExpectCounted(Repeated(std::string("\xf8\x7f\x01", 3), 10'000), "unknown numbers");
  ExpectCounted(Mesh(20'000, 40'000).SerializeAsString(), "a mesh");
  v1::Scene packed;
  for (int i = 0; i < 10'000; ++i) packed.mutable_breath()->add_trace(i);
  ExpectCounted(packed.SerializeAsString(), "a list of numbers");
}

TEST(UnfoldedBytes, EndAtTheLimitAndAtWhatIsNoProtobuf) {
  const auto count = [](const std::string& bytes, std::size_t enough) {
    return UnfoldedBytes(BytesOf(bytes), *v1::Scene::descriptor(), enough);
  };
  const std::string bodies = Repeated(std::string("\x2a\x00", 2), 100'000);
  const std::size_t all = count(bodies, kAll);
  EXPECT_LT(count(bodies, all / 100), all / 50);
  EXPECT_EQ(count("\xff\xff\xff\xff\xff\xff\xff\xff\xff\xff\xff", kAll), 0u);
  EXPECT_LT(count(std::string("\x2a\x05", 2) + bodies, kAll), all) << "a body is not as long as it says";
  EXPECT_LT(count(Repeated("\x0b", 1'000'000), kAll), 100'000u) << "groups are deeper than the parser goes";
  EXPECT_GT(count(Repeated("\xfb\x7f\xfc\x7f", 10'000), kAll), 10'000u * 32) << "unknown groups side by side";
}

TEST(Parse, AMeshIsRead) {
  const v1::Scene scene = Mesh(200'000, 400'000);
  v1::Scene read;
  const absl::Status parsed = Parse(Serialize(scene), read);
  EXPECT_TRUE(parsed.ok()) << parsed;
  EXPECT_EQ(read.bodies(0).polyhedron().triangles_size(), 400'000);
}

TEST(Parse, ManyEmptyEntriesAreRefused) {
  v1::Scene read;
  EXPECT_TRUE(absl::IsResourceExhausted(Parse(BytesOf(Repeated(std::string("\x2a\x00", 2), 500'000)), read)));
  EXPECT_EQ(read.bodies_size(), 0);
  EXPECT_TRUE(absl::IsInvalidArgument(Parse(BytesOf("\xff\xff"), read)));
}

TEST(Parse, UnknownFieldsOfALargeMessageAreDropped) {
  v1::Scene scene = Mesh(10'000, 10'000), read;
  const std::string known = scene.SerializeAsString();
  scene.GetReflection()->MutableUnknownFields(&scene)->AddLengthDelimited(1000, std::string(1 << 20, 'x'));
  ASSERT_TRUE(Parse(Serialize(scene), read).ok());
  EXPECT_EQ(read.SerializeAsString(), known);
}

class RequestSize : public ProcessFixture {
 protected:
  template <class Stub, class Request, class Response>
  static grpc::Status Call(const std::unique_ptr<Stub>& stub,
                           grpc::Status (Stub::*method)(grpc::ClientContext*, const Request&, Response*),
                           const Request& request) {
    grpc::ClientContext context;
    context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(60));
    Response response;
    return (stub.get()->*method)(&context, request, &response);
  }
};

TEST_F(RequestSize, AMessageOfEmptyEntriesTakesLittleMemory) {
  Start();
  const std::int64_t before = server_->Memory();
  v1::DescribeSceneRequest request;
  auto& bodies = *request.mutable_source()->mutable_scene()->mutable_bodies();
  bodies.Reserve(2'000'000);
  for (int i = 0; i < 2'000'000; ++i) bodies.Add();
  const grpc::Status status =
      Call(v1::SceneService::NewStub(server_->NewChannel()), &v1::SceneService::Stub::DescribeScene, request);
  EXPECT_EQ(status.error_code(), grpc::RESOURCE_EXHAUSTED) << status.error_message();
  EXPECT_LT(server_->Memory() - before, 64 << 20);
}

// A watch holds its request for as long as it lasts.
TEST_F(RequestSize, LargeRequestsOfOneConnectionDoNotPileUp) {
  Start();
  const auto channel = server_->NewChannel();
  v1::CreateStudyRequest study;
  study.set_study_id("long");
  study.mutable_source()->set_name("sheet-2d");
  study.mutable_error()->set_seconds(120);
  study.mutable_error()->set_levels(16);
  const grpc::Status created = Call(v1::StudyService::NewStub(channel), &v1::StudyService::Stub::CreateStudy, study);
  ASSERT_TRUE(created.ok()) << created.error_message();
  v1::WatchStudyRequest watch;
  watch.set_study_id("long");
  watch.GetReflection()->MutableUnknownFields(&watch)->AddLengthDelimited(1000, std::string(15 << 20, 'x'));
  struct Stream {
    grpc::ClientContext context;
    std::unique_ptr<grpc::ClientReader<v1::WatchStudyResponse>> reader;
  };
  std::vector<std::unique_ptr<Stream>> streams;
  const auto starts = [&](const std::shared_ptr<grpc::Channel>& caller) {
    Stream& stream = *streams.emplace_back(std::make_unique<Stream>());
    stream.reader = v1::StudyService::NewStub(caller)->WatchStudy(&stream.context, watch);
    v1::WatchStudyResponse response;
    return stream.reader->Read(&response);
  };
  for (int i = 0; i < 8; ++i) ASSERT_TRUE(starts(channel)) << i;
  EXPECT_FALSE(starts(channel));
  const grpc::Status refused = streams.back()->reader->Finish();
  streams.pop_back();
  EXPECT_EQ(refused.error_code(), grpc::RESOURCE_EXHAUSTED);
  EXPECT_NE(refused.error_message().find("large requests"), std::string::npos) << refused.error_message();
  EXPECT_TRUE(starts(server_->NewChannel())) << "another caller is refused";
  for (const auto& stream : streams) stream->context.TryCancel();
  for (const auto& stream : streams) stream->reader->Finish();
}

}  // namespace
}  // namespace phrenic::service
