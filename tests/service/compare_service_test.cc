// CompareService over a socket.
#include "phrenic/v1/compare.grpc.pb.h"
#include "tests/service/server_fixture.h"

namespace phrenic::service {
namespace {

using ::testing::HasSubstr;

constexpr char kObj[] = "v 0 0 0\nv 100 0 0\nv 0 100 0\nf 1 2 3\n";

v1::CompareRequest Request(const std::string& a, const std::string& b) {
  v1::CompareRequest request;
  request.mutable_a()->set_name("a.obj");
  request.mutable_a()->set_content(a);
  request.mutable_b()->set_name("b.obj");
  request.mutable_b()->set_content(b);
  return request;
}

class CompareServiceTest : public ServerFixture {
 protected:
  grpc::Status Compare(const v1::CompareRequest& request, std::vector<v1::CompareResponse>* responses = nullptr) {
    grpc::ClientContext context;
    context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(30));
    const auto stub = v1::CompareService::NewStub(channel_);
    const auto reader = stub->Compare(&context, request);
    v1::CompareResponse response;
    while (reader->Read(&response)) {
      if (responses != nullptr) responses->push_back(response);
    }
    return reader->Finish();
  }
};

TEST_F(CompareServiceTest, SendsProgressThenTheMapThenTheTable) {
  v1::CompareRequest request = Request(kObj, "v 0 0 2\nv 100 0 2\nv 0 100 2\nf 1 2 3\n");
  request.set_map_format("vtp");
  std::vector<v1::CompareResponse> responses;
  const grpc::Status status = Compare(request, &responses);
  ASSERT_TRUE(status.ok()) << status.error_message();
  ASSERT_EQ(responses.size(), 3U);
  EXPECT_TRUE(responses[0].has_progress());
  EXPECT_THAT(responses[1].map_chunk(), HasSubstr("VTKFile"));
  EXPECT_NEAR(responses[2].table().rows(0).distance().hd_max(), 2, 1e-9);
}

TEST_F(CompareServiceTest, BadRequestsNameTheFieldOrTheFile) {
  grpc::Status status = Compare(v1::CompareRequest());
  EXPECT_EQ(status.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_THAT(status.error_message(), HasSubstr("a: must be set"));
  v1::CompareRequest request = Request(kObj, kObj);
  request.set_tolerance_mm(-1);
  EXPECT_THAT(Compare(request).error_message(), HasSubstr("tolerance_mm: -1 is outside"));
  EXPECT_THAT(Compare(Request(kObj, "")).error_message(), HasSubstr("b.obj:"));
}

// A triangle 1 m above the origin, whose distance to the resting cube is known.
TEST_F(CompareServiceTest, ASessionsBodyIsComparedInItsCurrentState) {
  CreateCube("cube");
  v1::CompareRequest request = Request("", kObj);
  request.mutable_a()->clear_name();
  request.mutable_a()->mutable_body()->set_session_id("cube");
  request.set_vertex_distances(true);
  std::vector<v1::CompareResponse> responses;
  const grpc::Status status = Compare(request, &responses);
  ASSERT_TRUE(status.ok()) << status.error_message();
  ASSERT_EQ(responses.size(), 3U);
  ASSERT_TRUE(responses[1].has_vertices());
  const v1::ComparisonTable& table = responses[2].table();
  EXPECT_EQ(table.state_a().session_id(), "cube");
  EXPECT_EQ(table.state_a().body(), "cube");
  EXPECT_EQ(table.state_a().tick(), 0);
  double farthest = 0;
  for (const float distance : responses[1].vertices().distances()) farthest = std::max<double>(farthest, distance);
  EXPECT_NEAR(farthest, table.rows(0).distance().hd_a_to_b(), 1e-3) << "a flat face is farthest at a corner";

  v1::StepSessionResponse stepped;
  ASSERT_TRUE(Call(*sessions_, &v1::SessionService::Stub::StepSession, "session_id: 'cube' ticks: 40", &stepped).ok());
  ASSERT_TRUE(Compare(request, &responses).ok());
  EXPECT_EQ(responses.back().table().state_a().tick(), 40);
  EXPECT_EQ(responses.back().table().state_a().time(), stepped.session().time());
}

TEST_F(CompareServiceTest, AMissingBodyIsNamed) {
  CreateCube("cube");
  v1::CompareRequest request = Request("", kObj);
  request.mutable_a()->clear_name();
  v1::SessionBody& body = *request.mutable_a()->mutable_body();
  EXPECT_THAT(Compare(request).error_message(), HasSubstr("a.body.session_id: must be set"));
  body.set_session_id("nobody");
  EXPECT_EQ(Compare(request).error_code(), grpc::StatusCode::NOT_FOUND);
  body.set_session_id("cube");
  body.set_body("ball");
  const grpc::Status status = Compare(request);
  EXPECT_EQ(status.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_THAT(status.error_message(), HasSubstr("body: there is no body \"ball\" with a surface; there are cube"));
}

TEST_F(CompareServiceTest, MoreThanSixteenMebibytesAreRefused) {
  const grpc::Status status = Compare(Request(kObj, std::string(std::size_t{17} << 20, '\n')));
  EXPECT_EQ(status.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
}

class NoComparisons : public CompareServiceTest {
 protected:
  NoComparisons() { options_.limits.exports = 0; }
};

TEST_F(NoComparisons, AreRefusedAboveTheLimit) {
  const grpc::Status status = Compare(Request(kObj, kObj));
  EXPECT_EQ(status.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_THAT(status.error_message(), HasSubstr("there are 0 comparisons, which is the limit (--max-exports"));
}

}  // namespace
}  // namespace phrenic::service
