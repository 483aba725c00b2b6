// Comparisons over a socket.
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

TEST_F(CompareServiceTest, ProgressThenTheMapThenTheTable) {
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

TEST_F(CompareServiceTest, MoreThanSixteenMebibytesAreRefused) {
  const grpc::Status status = Compare(Request(kObj, std::string(std::size_t{17} << 20, '\n')));
  EXPECT_EQ(status.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
}

class NoComparisons : public CompareServiceTest {
 protected:
  NoComparisons() { options_.limits.exports = 0; }
};

TEST_F(NoComparisons, AreRefusedPastTheLimit) {
  const grpc::Status status = Compare(Request(kObj, kObj));
  EXPECT_EQ(status.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_THAT(status.error_message(), HasSubstr("0 comparisons are under way"));
}

}  // namespace
}  // namespace phrenic::service
